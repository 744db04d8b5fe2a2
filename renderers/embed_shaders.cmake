# Writes OUTPUT, a .cpp that holds the shader files FILES (paths from the repository root, separated
# by |) and all they include, and DEPFILE, which names every file read.
# Other arguments: ROOT, the repository; TARGET, the kit or technique, also its namespace.
cmake_minimum_required(VERSION 3.25)
string(REPLACE "|" ";" waiting "${FILES}")
set(done "")
set(entries "")
set(inputs "")
while(waiting)
  list(POP_FRONT waiting path)
  if(path IN_LIST done)
    continue()
  endif()
  list(APPEND done "${path}")
  if(NOT EXISTS "${ROOT}/${path}")
    message(FATAL_ERROR "shader file ${path} of ${TARGET} does not exist")
  endif()
  file(READ "${ROOT}/${path}" text)
  string(APPEND entries "    {\"${path}\", R\"shader(${text})shader\"},\n")
  string(APPEND inputs " ${ROOT}/${path}")
  string(REGEX MATCHALL "(^|\n)[ \t]*#[ \t]*include[ \t]*\"[^\"\n]+\"" includes "${text}")
  foreach(include IN LISTS includes)
    string(REGEX REPLACE ".*\"([^\"]+)\"" "\\1" included "${include}")
    list(APPEND waiting "${included}")
  endforeach()
endwhile()
file(WRITE "${OUTPUT}" "// Generated from ${FILES}.
#include \"renderers/${TARGET}/shader_files.h\"

namespace renderers::${TARGET} {

namespace {
constexpr opengl::ShaderFile kFiles[] = {
${entries}};
}  // namespace

std::span<const opengl::ShaderFile> shader_files() { return kFiles; }

}  // namespace renderers::${TARGET}
")
file(WRITE "${DEPFILE}" "${OUTPUT}:${inputs}\n")
