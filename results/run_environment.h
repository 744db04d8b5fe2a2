#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace results {

/// What the run ran on and was built from; goes into run.json.
///
/// {"machine","cpu","cores","memory_bytes","os","kernel","version","compiler","build_type",
///  "commit","commit_dirty","libraries":{name:version},"governor","load_average","started_utc"}
/// What cannot be found out is null: `governor` in a virtual machine; `commit` when the folder the
/// program was built from is gone or is not a git checkout.
nlohmann::ordered_json run_environment();

/// Short stable name of this machine: host name and CPU model, path-safe.
std::string machine_name();

}  // namespace results
