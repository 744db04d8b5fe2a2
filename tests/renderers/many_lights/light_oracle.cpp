#include "tests/renderers/many_lights/light_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <glm/geometric.hpp>

#include "tests/renderers/ggx_oracle.h"

namespace renderers::test {

namespace {

constexpr double kPi = std::numbers::pi;

std::size_t index_of(const many_lights::SurfaceImage& surfaces, int x_px, int y_px) {
  return static_cast<std::size_t>(y_px) * static_cast<std::size_t>(surfaces.width_px) +
         static_cast<std::size_t>(x_px);
}

/// Phong: rho_s (n + 2) / (2 pi) cos^n of the angle between the light and the mirrored viewer.
glm::dvec3 lobe(const scene::Material& material, const OracleReceiver& receiver,
                const glm::dvec3& camera, const glm::dvec3& light_position) {
  const glm::dvec3 to_viewer = glm::normalize(camera - receiver.position);
  const glm::dvec3 to_light = glm::normalize(light_position - receiver.position);
  const glm::dvec3& normal = receiver.shading_normal;
  const glm::dvec3 mirror = 2.0 * glm::dot(normal, to_viewer) * normal - to_viewer;
  const double cosine = glm::dot(mirror, to_light);
  if (material.lobe.shape == scene::LobeShape::ggx) {
    return glm::dvec3(material.lobe.albedo) *
           test::ggx_value(static_cast<double>(material.lobe.alpha), normal, to_viewer, to_light);
  }
  if (cosine <= 0.0) return glm::dvec3(0.0);
  const auto exponent = static_cast<double>(material.lobe.exponent);
  return glm::dvec3(material.lobe.albedo) *
         ((exponent + 2.0) / (2.0 * kPi) * std::pow(cosine, exponent));
}

/// Weight of a neighbour at an offset along one axis.
double tap_weight(const many_lights::BlurSettings& settings, int offset) {
  const int n = settings.interleave;
  const bool is_centred = settings.kind == many_lights::BlurKind::centred && n % 2 == 0;
  if (is_centred) return std::abs(offset) < n / 2 ? 1.0 : std::abs(offset) == n / 2 ? 0.5 : 0.0;
  return offset >= -(n / 2) && offset < n - n / 2 ? 1.0 : 0.0;
}

bool are_alike(const many_lights::SurfaceImage& surfaces, std::size_t a, std::size_t b,
               const many_lights::BlurSettings& settings) {
  if (surfaces.position[b].w <= 0.0F) return false;
  if (a == b) return true;
  const double distance_m =
      glm::distance(glm::dvec3(surfaces.position[a]), glm::dvec3(surfaces.position[b]));
  const double cosine =
      glm::dot(glm::dvec3(surfaces.shading_normal[a]), glm::dvec3(surfaces.shading_normal[b]));
  return distance_m < static_cast<double>(settings.alpha_m) &&
         cosine > static_cast<double>(settings.beta);
}

/// One pass; rows of taps if `has_rows`, columns if `has_columns`.
std::vector<glm::dvec3> blur_pass(const many_lights::SurfaceImage& surfaces,
                                  const std::vector<glm::dvec3>& values,
                                  const many_lights::BlurSettings& settings, bool has_rows,
                                  bool has_columns) {
  std::vector<glm::dvec3> blurred(values.size(), glm::dvec3(0.0));
  const int reach = settings.interleave / 2;
  const int reach_x = has_rows ? reach : 0;
  const int reach_y = has_columns ? reach : 0;
  for (int y = 0; y < surfaces.height_px; ++y) {
    for (int x = 0; x < surfaces.width_px; ++x) {
      const std::size_t own = index_of(surfaces, x, y);
      if (surfaces.position[own].w <= 0.0F) continue;
      double total = 0.0;
      for (int j = std::max(y - reach_y, 0); j <= std::min(y + reach_y, surfaces.height_px - 1);
           ++j) {
        for (int i = std::max(x - reach_x, 0); i <= std::min(x + reach_x, surfaces.width_px - 1);
             ++i) {
          const std::size_t other = index_of(surfaces, i, j);
          const double weight = (has_rows ? tap_weight(settings, i - x) : 1.0) *
                                (has_columns ? tap_weight(settings, j - y) : 1.0);
          if (weight == 0.0 || !are_alike(surfaces, own, other, settings)) continue;
          blurred[own] += weight * values[other];
          total += weight;
        }
      }
      blurred[own] /= total;
    }
  }
  return blurred;
}

}  // namespace

OracleLight oracle_light(const many_lights::VirtualLight& light) {
  return {glm::dvec3(light.position), glm::dvec3(light.geometric_normal),
          glm::dvec3(light.shading_normal), glm::dvec3(light.flux), light.position.w > 0.0F};
}

OracleReceiver oracle_receiver(const many_lights::SurfaceImage& surfaces, std::size_t pixel) {
  return {glm::dvec3(surfaces.position[pixel]), glm::dvec3(surfaces.geometric_normal[pixel]),
          glm::dvec3(surfaces.shading_normal[pixel])};
}

many_lights::VirtualLight flat_light(const glm::dvec3& position, const glm::dvec3& normal,
                                     const glm::dvec3& flux) {
  return {glm::vec4(position, 1.0), glm::vec4(normal, 0.0), glm::vec4(normal, 0.0),
          glm::vec4(flux, 0.0)};
}

glm::dvec3 oracle_irradiance(const OracleLight& light, const OracleReceiver& receiver,
                             double geometry_clamp, Mistake mistake) {
  if (!light.is_valid) return glm::dvec3(0.0);
  const glm::dvec3 between = light.position - receiver.position;
  const double distance2 = glm::dot(between, between);
  if (distance2 <= 0.0) return glm::dvec3(0.0);
  const glm::dvec3 to_light = between / std::sqrt(distance2);
  const double side = mistake == Mistake::swapped_normal ? 1.0 : -1.0;
  const double cos_light = side * glm::dot(light.geometric_normal, to_light);
  const double cos_receiver = glm::dot(receiver.shading_normal, to_light);
  if (cos_light <= 0.0 || cos_receiver <= 0.0) return glm::dvec3(0.0);
  if (glm::dot(receiver.geometric_normal, to_light) <= 0.0) return glm::dvec3(0.0);
  const double power = mistake == Mistake::distance_to_the_fourth ? 4.0 : 2.0;
  const double falloff = std::pow(distance2, -0.5 * power);
  const double bounded =
      cos_receiver * std::abs(glm::dot(light.shading_normal, to_light)) / distance2;
  const double kept = geometry_clamp > 0.0 ? std::min(1.0, geometry_clamp / bounded) : 1.0;
  const double pi = mistake == Mistake::missing_pi ? 1.0 : kPi;
  return light.flux / pi * (cos_receiver * cos_light * falloff * kept);
}

std::vector<std::size_t> oracle_run(int x_px, int y_px, int interleave, int light_count,
                                    Mistake mistake) {
  std::vector<std::size_t> run;
  const int classes = interleave * interleave;
  const int own = (y_px % interleave) * interleave + x_px % interleave;
  for (int i = 0; i < light_count; ++i) {
    // Light i is in run s where s N / n^2 <= i < (s + 1) N / n^2, both rounded down.
    const double position = (i + 1.0) * classes / light_count;
    const int contiguous = static_cast<int>(std::ceil(position - 1e-9)) - 1;
    const int in_class = mistake == Mistake::strided_runs ? i % classes : contiguous;
    if (in_class == own) run.push_back(static_cast<std::size_t>(i));
  }
  return run;
}

OraclePicture oracle_gather(const many_lights::SurfaceImage& surfaces,
                            const std::vector<many_lights::VirtualLight>& lights,
                            const std::vector<scene::Material>& materials,
                            const many_lights::GatherSettings& settings) {
  const std::size_t pixels = surfaces.position.size();
  OraclePicture picture{std::vector<glm::dvec3>(pixels, glm::dvec3(0.0)),
                        std::vector<glm::dvec3>(pixels, glm::dvec3(0.0))};
  const double scale = settings.interleave * settings.interleave;
  for (int y = 0; y < surfaces.height_px; ++y) {
    for (int x = 0; x < surfaces.width_px; ++x) {
      const std::size_t pixel = index_of(surfaces, x, y);
      if (surfaces.position[pixel].w <= 0.0F) continue;
      const OracleReceiver receiver = oracle_receiver(surfaces, pixel);
      for (const std::size_t i :
           oracle_run(x, y, settings.interleave, static_cast<int>(lights.size()))) {
        const OracleLight light = oracle_light(lights[i]);
        const glm::dvec3 received =
            scale *
            oracle_irradiance(light, receiver, static_cast<double>(settings.geometry_clamp));
        picture.irradiance[pixel] += received;
        if (!settings.with_glossy || surfaces.albedo[pixel].w <= 0.0F) continue;
        const auto material = static_cast<std::size_t>(surfaces.geometric_normal[pixel].w);
        picture.glossy[pixel] +=
            received * lobe(materials[material], receiver, glm::dvec3(settings.camera_position),
                            light.position);
      }
    }
  }
  return picture;
}

std::vector<glm::dvec3> oracle_blur(const many_lights::SurfaceImage& surfaces,
                                    const std::vector<glm::dvec3>& values,
                                    const many_lights::BlurSettings& settings) {
  if (settings.interleave == 1) return values;
  if (settings.kind == many_lights::BlurKind::box) {
    return blur_pass(surfaces, values, settings, true, true);
  }
  return blur_pass(surfaces, blur_pass(surfaces, values, settings, true, false), settings, false,
                   true);
}

}  // namespace renderers::test
