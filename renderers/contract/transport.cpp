#include "renderers/contract/transport.h"

#include <array>
#include <string>

#include "perception/base/errors.h"
#include "perception/base/names.h"

namespace renderers {

namespace {

const std::array<std::string, 4> kTransportNames{"direct", "one_bounce", "diffuse", "full"};
const std::array<std::string, 2> kPartNames{"all", "indirect"};

template <std::size_t Count>
std::size_t index_of(const std::array<std::string, Count>& names, std::string_view kind,
                     std::string_view text) {
  for (std::size_t i = 0; i < Count; ++i) {
    if (base::is_same_name(names[i], text)) return i;
  }
  throw base::InputError(base::unknown_name(kind, text, names));
}

}  // namespace

std::string to_string(Transport transport) {
  return kTransportNames[static_cast<std::size_t>(transport)];
}

std::string to_string(Part part) { return kPartNames[static_cast<std::size_t>(part)]; }

Transport transport_from_text(std::string_view text) {
  return static_cast<Transport>(index_of(kTransportNames, "transport", text));
}

Part part_from_text(std::string_view text) {
  return static_cast<Part>(index_of(kPartNames, "part", text));
}

}  // namespace renderers
