#pragma once

#include <memory>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <glm/vec3.hpp>

#include "renderers/many_lights/gather.h"
#include "renderers/many_lights/surface_image.h"
#include "renderers/many_lights/virtual_light.h"
#include "renderers/opengl/context.h"
#include "renderers/opengl/geometry_buffer.h"

namespace renderers::test {

/// Tests with a context; a message of the driver fails them.
class GlTest : public testing::Test {
 protected:
  void SetUp() override { context_ = opengl::Context::create("egl-surfaceless"); }
  void TearDown() override {
    EXPECT_NO_THROW(context_->check("testing"));
    for (const std::string& message : context_->take_messages()) ADD_FAILURE() << message;
  }
  const std::shared_ptr<opengl::Context>& context() const { return context_; }

 private:
  std::shared_ptr<opengl::Context> context_;
};

/// Surfaces without any; fill its pixels.
many_lights::SurfaceImage empty_surfaces(int width_px, int height_px);
/// A diffuse white pixel of one normal. @param normal  unit length
void put_flat(many_lights::SurfaceImage& surfaces, std::size_t pixel, const glm::vec3& position,
              const glm::vec3& normal);

/// A geometry buffer that holds given surfaces instead of a drawn scene.
std::unique_ptr<opengl::GeometryBuffer> geometry_of(std::shared_ptr<opengl::Context> context,
                                                    const many_lights::SurfaceImage& surfaces);

opengl::Texture texture_of(std::shared_ptr<opengl::Context> context, int width_px, int height_px,
                           const std::vector<glm::dvec3>& values);
/// rgb of an rgba32f texture.
std::vector<glm::vec3> read_rgb(const opengl::Texture& texture);

struct Picture {
  std::vector<glm::vec3> irradiance;
  std::vector<glm::vec3> glossy;  ///< empty without it
};

struct GatherCall {
  many_lights::GatherSettings settings{};
  many_lights::GatherOrder order = many_lights::GatherOrder::in_place;
  int batch = 0;  ///< lights at a time; 0: all
};

/// The device's gather of some lights at some surfaces.
Picture gather_on_device(std::shared_ptr<opengl::Context> context,
                         const many_lights::SurfaceImage& surfaces,
                         const std::vector<many_lights::VirtualLight>& lights,
                         const opengl::GpuScene& scene, const GatherCall& call);

/// Numbers in [0, 1), the same every time.
class Numbers {
 public:
  double next();
  double between(double low, double high) { return low + (high - low) * next(); }
  glm::dvec3 direction();  ///< uniform, unit length
  glm::dvec3 in_box(double half_width);

 private:
  std::uint64_t count_ = 0;
};

}  // namespace renderers::test
