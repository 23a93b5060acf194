// What a profile tells: seconds by phase for the summary, and a trace that Perfetto and chrome://tracing open.
#pragma once

#include "solver/profile.hpp"

#include <filesystem>
#include <string>

namespace grandamp {

/// The text of a trace in the Trace Event Format (JSON, complete events, microseconds); one row per segment of the
/// granules. Holds the beginning of the run (Profile::events).
std::string trace_text(const Profile& profile);

} // namespace grandamp
