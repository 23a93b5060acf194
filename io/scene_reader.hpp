// The tables of a scene, one function per subject. Internal to io; faults go to SceneReading::findings.
#pragma once

#include "io/scene_table.hpp"
#include "solver/scene.hpp"

#include <vector>

namespace grandamp {

/// What other tables need to know of the populations.
struct GranulesRead {
  bool any = false;      ///< there are granules, or the key that says how many is faulty
  bool by_count = false; ///< some of them are for the packing to place
  std::vector<TableReader> tables;
};

/// All of it. The scene is meaningful only if no finding was added.
Scene read_tree(const toml::table& tree, SceneReading& reading);

GranulesRead read_granules(TableReader& root, Scene& scene);
void read_packing(TableReader& root, Scene& scene, GranulesRead& granules);
void read_contact(TableReader& root, Scene& scene, GranulesRead& granules);
void read_structure(TableReader& root, Scene& scene);
void read_excitation(TableReader& root, Scene& scene);         ///< after the structure
void check_table_reach(TableReader& root, const Scene& scene); ///< after the duration
void read_time(TableReader& root, Scene& scene);
void read_verlet(TableReader& root, Scene& scene);
void read_output(TableReader& root, Scene& scene);

} // namespace grandamp
