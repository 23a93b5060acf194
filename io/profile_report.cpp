#include "io/profile_report.hpp"

#include "io/json.hpp"

namespace grandamp {

std::string trace_text(const Profile& profile) {
  constexpr double microseconds = 1e6;
  Json events = Json::array();
  for (const Profile::Event& event : profile.events())
    events.push_back({{"name", phase_names[static_cast<std::size_t>(event.phase)]},
                      {"ph", "X"},
                      {"ts", microseconds * event.begin},
                      {"dur", microseconds * (event.end - event.begin)},
                      {"pid", 1},
                      {"tid", event.lane + 1}});
  return Json{{"traceEvents", events}, {"displayTimeUnit", "ns"}}.dump() + "\n";
}

} // namespace grandamp
