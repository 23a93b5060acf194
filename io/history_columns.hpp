// What a row of the histories holds, in the order of files and exports.
#pragma once

#include "solver/simulation.hpp"

#include <array>
#include <string_view>

namespace grandamp {

/// Rows as records of a log of this kind: doubles in the order below.
inline constexpr std::string_view history_kind = "history";

struct HistoryColumn {
  const char* name;
  const char* units;
  const char* description;
  bool of_ledger;
  double (*value)(const Sample&);
};

inline constexpr std::array history_columns{
    HistoryColumn{"time", "s", "time since the start of the run", false, [](const Sample& s) { return s.time; }},
    HistoryColumn{"displacement", "m", "of the enclosure along its direction, from the equilibrium without granules",
                  false, [](const Sample& s) { return s.displacement; }},
    HistoryColumn{"velocity", "m/s", "of the enclosure along its direction", false,
                  [](const Sample& s) { return s.velocity; }},
    HistoryColumn{"excitation", "N", "force on the structure along its direction; of a foundation in motion K y + c y'",
                  false, [](const Sample& s) { return s.excitation; }},
    HistoryColumn{"reaction", "N", "force of the granules on the enclosure along its direction", false,
                  [](const Sample& s) { return s.reaction; }},
    HistoryColumn{"kinetic", "J", "of the granules, translation and rotation, in the laboratory's frame", false,
                  [](const Sample& s) { return s.stored.kinetic; }},
    HistoryColumn{"elastic", "J", "stored in contacts", false, [](const Sample& s) { return s.stored.elastic; }},
    HistoryColumn{"gravitational", "J",
                  "of the granules, from the laboratory height of the enclosure's origin at x = 0", false,
                  [](const Sample& s) { return s.stored.gravitational; }},
    HistoryColumn{"contacts", "1", "contacts between granules and with the enclosure", false,
                  [](const Sample& s) { return static_cast<double>(s.contacts); }},
    HistoryColumn{"work_in", "J", "work of the excitation since t = 0", true,
                  [](const Sample& s) { return s.ledger.work_in; }},
    HistoryColumn{"structural_damping", "J", "lost in the structure's own damper since t = 0", true,
                  [](const Sample& s) { return s.ledger.structural_damping; }},
    HistoryColumn{"normal_granule", "J", "lost to normal damping between granules since t = 0", true,
                  [](const Sample& s) { return s.ledger.normal_granule; }},
    HistoryColumn{"normal_wall", "J", "lost to normal damping at the enclosure since t = 0", true,
                  [](const Sample& s) { return s.ledger.normal_wall; }},
    HistoryColumn{"friction_granule", "J", "lost to friction between granules since t = 0", true,
                  [](const Sample& s) { return s.ledger.friction_granule; }},
    HistoryColumn{"friction_wall", "J", "lost to friction at the enclosure since t = 0", true,
                  [](const Sample& s) { return s.ledger.friction_wall; }},
    HistoryColumn{"structure", "J", "kinetic and spring energy of the host structure", true,
                  [](const Sample& s) { return s.stored.structure; }},
};

} // namespace grandamp
