#pragma once

#include <string>
#include <string_view>

namespace renderers::scene {

/// Checks a 3DS file: every chunk's length against its parent's, the vertex and face counts against
/// their chunks, coordinates finite, face indices below their object's vertex count, faces of
/// materials below its face count.
/// @param file  the name for messages
/// @throws base::InputError naming the file, the object, and the face or vertex
void check_3ds(std::string_view data, const std::string& file);

}  // namespace renderers::scene
