#include "renderers/opengl/context.h"

#include <cstdlib>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "perception/base/errors.h"
#include "renderers/opengl/buffer.h"
#include "renderers/opengl/gl_functions.h"
#include "renderers/opengl/texture.h"
#include "renderers/renderer_list.h"
#include "tests/expect_error.h"
#include "tests/renderers/opengl/platform_test.h"

namespace renderers::opengl {
namespace {

class ContextGlTest : public PlatformTest {};
INSTANTIATE_TEST_SUITE_P(Platforms, ContextGlTest, all_platforms(), platform_label);

TEST_P(ContextGlTest, SaysWhatItIs) {
  const DeviceFacts& facts = context_->facts();
  EXPECT_EQ(facts.platform, GetParam());
  EXPECT_EQ(to_string(context_->platform()), GetParam());
  EXPECT_FALSE(facts.renderer.empty());
  EXPECT_FALSE(facts.vendor.empty());
  EXPECT_GE(facts.version, "4.5");
  EXPECT_EQ(facts.is_software, facts.renderer.find("llvmpipe") != std::string::npos);
  for (const auto& [name, value] : facts.limits) {
    const bool may_be_none = name == "max_vertex_storage_blocks";
    EXPECT_GT(value, may_be_none ? -1.0 : 0.0) << name;
  }
  EXPECT_EQ(facts.limits.size(), 11U);
}

/// The least values of OpenGL 4.5, tables 23.53 to 23.72.
TEST_P(ContextGlTest, AllowsWhatOpenGlGuarantees) {
  const Limits& limits = context_->limits();
  EXPECT_GE(limits.texture_size_px, 16384);
  EXPECT_GE(limits.array_layers, 2048);
  EXPECT_GE(limits.storage_block_bytes, 1 << 24);
  EXPECT_GE(limits.storage_blocks, 8);
  EXPECT_GE(limits.fragment_storage_blocks, 8);
  EXPECT_GE(limits.storage_bindings, 8);
  EXPECT_GE(limits.work_group_invocations, 1024);
  EXPECT_GE(limits.work_groups, 65535);
  EXPECT_GE(limits.shared_memory_bytes, 32 << 10);
  EXPECT_GE(limits.image_units, 8);
}

TEST_P(ContextGlTest, TurnsAMistakeIntoAnErrorWithTheDriversWords) {
  context_->use().BindBufferBase(GL_TRIANGLES, 0, 0);
  tests::expect_error_with<base::DeviceError>(
      [&] { context_->check("binding nonsense"); },
      {"OpenGL: invalid enumerator while binding nonsense: ", "GL_INVALID_ENUM"});
  EXPECT_NO_THROW(context_->check("nothing more"));
  EXPECT_TRUE(context_->take_messages().empty());
}

TEST_P(ContextGlTest, IsProbed) {
  const DeviceFacts facts = probe_device(GetParam());
  EXPECT_EQ(facts.platform, GetParam());
  EXPECT_EQ(facts.renderer, context_->facts().renderer);
}

/// Stands in for a driver that lost the context.
GLenum APIENTRY answer_reset() { return GL_INNOCENT_CONTEXT_RESET; }

TEST_P(ContextGlTest, IsReplacedAfterALoss) {
  Devices devices;
  devices.platform = GetParam();
  devices.warm = std::make_shared<WarmStore>();
  const auto lost = Context::of(devices);
  const_cast<Functions&>(lost->use()).GetGraphicsResetStatus = answer_reset;
  EXPECT_FALSE(lost->is_lost());
  tests::expect_error_with<base::DeviceError>(
      [&] { lost->check("gathering"); },
      {"context lost: the device was reset because of another program, while gathering"});
  EXPECT_TRUE(lost->is_lost());
  const auto next = Context::of(devices);
  EXPECT_NE(next, lost);
  EXPECT_NO_THROW(Buffer(next, 64));
  EXPECT_EQ(Context::of(devices), next);
}

TEST_P(ContextGlTest, IsKeptWarmByItsName) {
  Devices devices;
  devices.platform = GetParam();
  EXPECT_NE(Context::of(devices), Context::of(devices));
  devices.warm = std::make_shared<WarmStore>();
  const auto context = Context::of(devices);
  EXPECT_EQ(Context::of(devices), context);
  EXPECT_EQ(devices.warm->count("opengl/" + GetParam()), 1U);
}

/// Numbers on the device and what they should be.
struct Numbers {
  explicit Numbers(const std::string& platform, std::uint32_t first)
      : context(Context::create(platform)),
        expected{first, first + 1, first + 2},
        buffer(Buffer::of(context, std::span<const std::uint32_t>(expected))),
        texture(context, {TextureFormat::r32ui, 2, 2}) {
    texture.clear_words(first);
  }
  void check() const {
    EXPECT_EQ(buffer.read<std::uint32_t>(3), expected);
    EXPECT_EQ(texture.read_words(), std::vector<std::uint32_t>(4, expected.front()));
    context->check("reading the numbers");
  }

  std::shared_ptr<Context> context;
  std::vector<std::uint32_t> expected;
  Buffer buffer;
  Texture texture;
};

/// Names of objects are equal in all of them, so a call to a wrong context would show.
TEST(Contexts, OfBothLibrariesLiveSideBySide) {
  Numbers first("egl-surfaceless", 100);
  Numbers second("osmesa", 200);
  Numbers third("egl-surfaceless", 300);
  Numbers fourth("osmesa", 400);
  EXPECT_EQ(first.buffer.id(), second.buffer.id());
  for (int round = 0; round < 3; ++round) {
    for (const Numbers* each : {&first, &second, &third, &fourth, &second, &first}) each->check();
  }
  for (Numbers* each : {&fourth, &first, &third, &second}) {
    for (std::uint32_t& number : each->expected) number += 7;
    each->buffer.write(std::span<const std::uint32_t>(each->expected));
    each->texture.clear_words(each->expected.front());
  }
  for (const Numbers* each : {&first, &second, &third, &fourth}) each->check();
}

TEST(Contexts, MayBeDestroyedInAnyOrder) {
  const std::vector<std::vector<std::size_t>> orders{
      {0, 1, 2, 3}, {3, 2, 1, 0}, {1, 0, 3, 2}, {2, 3, 0, 1}, {1, 3, 0, 2}};
  for (const std::vector<std::size_t>& order : orders) {
    std::vector<std::unique_ptr<Numbers>> numbers;
    for (const char* platform : {"egl-surfaceless", "osmesa", "egl-surfaceless", "osmesa"}) {
      numbers.push_back(std::make_unique<Numbers>(
          platform, static_cast<std::uint32_t>(100 * numbers.size() + 100)));
    }
    for (const std::size_t index : order) {
      numbers[index].reset();
      for (const auto& each : numbers) {
        if (each) each->check();
      }
    }
  }
}

TEST(Contexts, LiveAsLongAsTheirResources) {
  Buffer buffer;
  {
    const auto context = Context::create("osmesa");
    buffer.reserve(context, 8);
    buffer.fill(5);
  }
  const auto other = Context::create("egl-surfaceless");
  EXPECT_EQ(buffer.read<std::uint32_t>(2), std::vector<std::uint32_t>(2, 5));
}

TEST(Contexts, TakeTheFirstPlatformThatWorks) {
  const auto context = Context::create("auto");
  const std::vector<std::string> names = device_platforms();
  const std::vector<std::string> expected{"egl-device", "egl-surfaceless", "osmesa"};
  EXPECT_EQ(names, expected);
  EXPECT_NE(context->facts().platform, "osmesa") << "EGL surfaceless comes before";
}

/// The same device however it is asked for; a software one is none, and so is none at all.
TEST_P(ContextGlTest, IsHardwareOrNone) {
  Devices devices;
  devices.platform = GetParam();
  devices.warm = std::make_shared<WarmStore>();
  const auto found = Context::hardware_of(devices);
  EXPECT_EQ(found != nullptr, !context_->is_software());
  if (found) {
    EXPECT_EQ(found->facts().renderer, context_->facts().renderer);
  }
  devices.platform = "auto";
  const bool has_device = Context::create("auto")->platform() == Platform::egl_device;
  EXPECT_EQ(Context::hardware_of(devices) != nullptr, has_device);
  devices.platform = "glx";
  EXPECT_THROW(Context::hardware_of(devices), base::InputError);
}

TEST(Contexts, RefuseUnknownPlatforms) {
  tests::expect_error<base::InputError>(
      [] { Context::create("osmessa"); },
      "unknown platform \"osmessa\"; did you mean \"osmesa\"? known: auto, egl-device, "
      "egl-surfaceless, osmesa");
}

TEST(Contexts, SayWhichPackagesHoldAMissingLibrary) {
  setenv("DISCERN_EGL_LIBRARY", "libNoSuchEGL.so.1", 1);
  setenv("DISCERN_OSMESA_LIBRARY", "libNoSuchOSMesa.so", 1);
  const std::string egl =
      "cannot open libNoSuchEGL.so.1 (libNoSuchEGL.so.1: cannot open shared object file: No such "
      "file or directory); Debian packages with it: libegl1 and libgl1-mesa-dri";
  const std::string osmesa =
      "cannot open libNoSuchOSMesa.so (libNoSuchOSMesa.so: cannot open shared object file: No such "
      "file or directory); Debian packages with it: libosmesa6";
  tests::expect_error<UnsupportedError>([] { Context::create("auto"); },
                                        "no OpenGL 4.5 core: egl-device: " + egl +
                                            "; egl-surfaceless: " + egl + "; osmesa: " + osmesa);
  tests::expect_error<UnsupportedError>([] { probe_device("osmesa"); },
                                        "no OpenGL 4.5 core: osmesa: " + osmesa);
  unsetenv("DISCERN_EGL_LIBRARY");
  unsetenv("DISCERN_OSMESA_LIBRARY");
}

/// A library that opens but is another one.
TEST(Contexts, SayWhatALibraryLacks) {
  setenv("DISCERN_OSMESA_LIBRARY", "libm.so.6", 1);
  tests::expect_error<UnsupportedError>(
      [] { Context::create("osmesa"); },
      "no OpenGL 4.5 core: osmesa: libm.so.6 lacks the function OSMesaCreateContextAttribs");
  unsetenv("DISCERN_OSMESA_LIBRARY");
}

}  // namespace
}  // namespace renderers::opengl
