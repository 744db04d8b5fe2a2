# Writes OUTPUT, a .cpp that holds every file of SCHEMAS (paths separated by |) as text.
string(REPLACE "|" ";" SCHEMAS "${SCHEMAS}")
set(entries "")
foreach(path IN LISTS SCHEMAS)
  get_filename_component(name "${path}" NAME_WE)
  file(READ "${path}" text)
  string(APPEND entries "    {\"${name}\", R\"schema(${text})schema\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "// Generated from suites/command_line/schemas/*.json.
#include \"suites/command_line/schemas.h\"

namespace suites::command_line {

namespace {
constexpr EmbeddedSchema kSchemas[] = {
${entries}};
}  // namespace

std::span<const EmbeddedSchema> embedded_schemas() { return kSchemas; }

}  // namespace suites::command_line
")
