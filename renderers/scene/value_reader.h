#pragma once

#include "perception/base/document.h"

#include <glm/vec3.hpp>

#include <string_view>

/// Values of scene files, checked; every message has file:line:column.
namespace renderers::scene {

/// A number that fits a float. @throws base::InputError
float read_float(const base::Node& node, std::string_view what);

/// A number > 0. @throws base::InputError
float read_positive(const base::Node& node, std::string_view what);

/// A number in [low, high]. @throws base::InputError
float read_in_range(const base::Node& node, std::string_view what, float low, float high);

/// [x, y, z]. @throws base::InputError
glm::vec3 read_vec3(const base::Node& node, std::string_view what);

/// [r, g, b] or one number for all three, each >= 0. @throws base::InputError
glm::vec3 read_color(const base::Node& node, std::string_view what);

/// Same, each in [0, 1]. @throws base::InputError
glm::vec3 read_reflectance(const base::Node& node, std::string_view what);

/// [x, y, z] scaled to unit length. @throws base::InputError if it is zero
glm::vec3 read_direction(const base::Node& node, std::string_view what);

/// A whole number in [low, high]. @throws base::InputError
int read_count(const base::Node& node, std::string_view what, int low, int high);

}  // namespace renderers::scene
