#include "renderers/opengl/context.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <functional>
#include <map>
#include <utility>

#include <fmt/core.h>

#include "perception/base/errors.h"
#include "perception/base/names.h"
#include "renderers/opengl/context_backend.h"
#include "renderers/opengl/device_facts.h"
#include "renderers/opengl/gl_functions.h"
#include "renderers/opengl/program.h"

namespace renderers::opengl {

namespace {

struct PlatformEntry {
  Platform platform;
  const char* name;
  std::unique_ptr<Context::Backend> (*open)();
};

/// In the order `auto` tries them.
constexpr std::array<PlatformEntry, 3> kPlatforms{
    {{Platform::egl_device, "egl-device", open_egl_device},
     {Platform::egl_surfaceless, "egl-surfaceless", open_egl_surfaceless},
     {Platform::osmesa, "osmesa", open_osmesa}}};

/// What is current on this thread, over all libraries: two libraries of Mesa share their dispatch
/// table, so the one must let go before the other takes over.
struct Current {
  std::uint64_t context = 0;  ///< serial number, 0: none
  std::function<void()> release;
};

Current& current_of_thread() {
  thread_local Current current;
  return current;
}

void release_current() {
  Current& current = current_of_thread();
  if (current.context != 0) current.release();
  current = {};
}

std::string error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "invalid enumerator";
    case GL_INVALID_VALUE:
      return "invalid value";
    case GL_INVALID_OPERATION:
      return "invalid operation";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "invalid framebuffer operation";
    case GL_OUT_OF_MEMORY:
      return "out of memory";
    case GL_CONTEXT_LOST:
      return "context lost";
    default:
      return fmt::format("error {:#x}", error);
  }
}

std::string reset_name(GLenum status) {
  switch (status) {
    case GL_GUILTY_CONTEXT_RESET:
      return "the device was reset because of this program";
    case GL_INNOCENT_CONTEXT_RESET:
      return "the device was reset because of another program";
    default:
      return "the device was reset for an unknown reason";
  }
}

struct Message {
  bool is_severe = false;
  std::string text;
};

void APIENTRY keep_message(GLenum, GLenum, GLuint, GLenum severity, GLsizei, const GLchar* text,
                           const void* messages) {
  static_cast<std::vector<Message>*>(const_cast<void*>(messages))
      ->push_back({severity == GL_DEBUG_SEVERITY_HIGH, text});
}

}  // namespace

std::string to_string(Platform platform) {
  return kPlatforms[static_cast<std::size_t>(platform)].name;
}

std::vector<std::string> platform_names() {
  std::vector<std::string> names;
  for (const PlatformEntry& entry : kPlatforms) names.emplace_back(entry.name);
  return names;
}

struct Context::Content {
  std::uint64_t serial = 0;
  std::unique_ptr<Backend> backend;
  Functions gl;
  GLuint vertex_array = 0;
  std::vector<Message> messages;
  bool is_lost = false;
  std::map<std::string, std::unique_ptr<Program>> programs;

  void load();
  void set_up_state();
};

/// Reads the entry points and refuses a context that is too old.
void Context::Content::load() {
  gl = load_functions([this](const char* name) { return backend->address_of(name); });
  require_version(gl);
}

/// State that is the same for all work, and the collection of messages.
void Context::Content::set_up_state() {
  gl.Enable(GL_DEBUG_OUTPUT);
  gl.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  gl.DebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
  for (const GLenum severity : {GL_DEBUG_SEVERITY_MEDIUM, GL_DEBUG_SEVERITY_HIGH}) {
    gl.DebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, severity, 0, nullptr, GL_TRUE);
  }
  // Advice, not faults: NVIDIA's driver tells of every read-back of a buffer in this way.
  gl.DebugMessageControl(GL_DONT_CARE, GL_DEBUG_TYPE_PERFORMANCE, GL_DONT_CARE, 0, nullptr,
                         GL_FALSE);
  gl.DebugMessageCallback(keep_message, &messages);
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl.CreateVertexArrays(1, &vertex_array);
  gl.BindVertexArray(vertex_array);
}

Context::Context(Platform platform, std::unique_ptr<Backend> backend)
    : platform_(platform), content_(std::make_unique<Content>()) {
  static std::atomic<std::uint64_t> last_serial = 0;
  content_->serial = ++last_serial;
  content_->backend = std::move(backend);
  use();
  try {
    content_->load();
    limits_ = limits_of(content_->gl);
    facts_ = facts_of(content_->gl, to_string(platform_), limits_);
    if (platform_ == Platform::egl_device && facts_.is_software) {
      throw UnsupportedError("the EGL device is software: " + facts_.renderer);
    }
    content_->set_up_state();
    check("making the context");
  } catch (...) {
    release_current();
    throw;
  }
}

Context::~Context() {
  try {
    const Functions& gl = use();
    content_->programs.clear();
    gl.DeleteVertexArrays(1, &content_->vertex_array);
    release_current();
  } catch (const base::DeviceError&) {
    // It cannot be made current any more; its objects go with it.
  }
}

std::shared_ptr<Context> Context::create(const std::string& platform) {
  const bool is_auto = base::is_same_name(platform, "auto");
  std::string answers;
  bool is_known = is_auto;
  for (const PlatformEntry& entry : kPlatforms) {
    if (!is_auto && !base::is_same_name(platform, entry.name)) continue;
    is_known = true;
    try {
      return std::shared_ptr<Context>(new Context(entry.platform, entry.open()));
    } catch (const UnsupportedError& error) {
      answers += fmt::format("{}{}: {}", answers.empty() ? "" : "; ", entry.name, error.what());
    } catch (const base::DeviceError& error) {
      answers += fmt::format("{}{}: {}", answers.empty() ? "" : "; ", entry.name, error.what());
    }
  }
  if (is_known) throw UnsupportedError("no OpenGL 4.5 core: " + answers);
  std::vector<std::string> known = platform_names();
  known.insert(known.begin(), "auto");
  throw base::InputError(base::unknown_name("platform", platform, known));
}

std::shared_ptr<Context> Context::of(const Devices& devices) {
  // Mesa's software driver reads this when it makes the first context of the process.
  if (devices.threads > 0) {
    setenv("LP_NUM_THREADS", std::to_string(devices.threads).c_str(), 0);
  }
  if (!devices.warm) return create(devices.platform);
  std::shared_ptr<WarmState>& kept = (*devices.warm)["opengl/" + devices.platform];
  auto context = std::dynamic_pointer_cast<Context>(kept);
  if (!context || context->is_lost()) {
    context = create(devices.platform);
    kept = context;
  }
  return context;
}

std::shared_ptr<Context> Context::hardware_of(const Devices& devices) {
  Devices asked = devices;
  if (base::is_same_name(asked.platform, "auto")) asked.platform = to_string(Platform::egl_device);
  if (base::is_same_name(asked.platform, to_string(Platform::osmesa))) return nullptr;
  try {
    auto context = of(asked);
    return context->is_software() ? nullptr : context;
  } catch (const UnsupportedError&) {
    return nullptr;
  }
}

bool Context::is_lost() const { return content_->is_lost; }

const Functions& Context::use() {
  if (current_of_thread().context != content_->serial) {
    release_current();
    content_->backend->make_current();
    current_of_thread() = {content_->serial, content_->backend->release()};
  }
  return content_->gl;
}

Program& Context::program(const ProgramSource& source) {
  // A table of files is known by its place: it is compiled into the program.
  std::string key = fmt::format("{}", static_cast<const void*>(source.files.data()));
  for (const std::string& stage : source.stages) key += "\n" + stage;
  for (const auto& [name, value] : source.defines) key += "\n" + name + "=" + value;
  std::unique_ptr<Program>& program = content_->programs[key];
  if (!program) program = std::make_unique<Program>(*this, source);
  return *program;
}

void Context::finish() { use().Finish(); }

std::vector<std::string> Context::take_messages() {
  std::vector<std::string> texts;
  for (Message& message : content_->messages) texts.push_back(std::move(message.text));
  content_->messages.clear();
  return texts;
}

void Context::check(std::string_view doing) {
  const Functions& gl = use();
  const GLenum reset = gl.GetGraphicsResetStatus();
  if (reset != GL_NO_ERROR) {
    content_->is_lost = true;
    throw base::DeviceError(fmt::format("context lost: {}, while {}", reset_name(reset), doing));
  }
  const GLenum error = gl.GetError();
  const bool has_severe = std::ranges::any_of(content_->messages, &Message::is_severe);
  if (error == GL_NO_ERROR && !has_severe) return;
  std::string reasons = error == GL_NO_ERROR ? "severe message" : error_name(error);
  reasons += fmt::format(" while {}", doing);
  for (const std::string& text : take_messages()) reasons += ": " + text;
  if (error == GL_OUT_OF_MEMORY) throw DeviceMemoryError("OpenGL: " + reasons);
  throw base::DeviceError("OpenGL: " + reasons);
}

DeviceFacts probe(const std::string& platform) { return Context::create(platform)->facts(); }

}  // namespace renderers::opengl
