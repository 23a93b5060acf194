// The granules in three dimensions: positions in 16 bits, colours in 8, picture by picture.
#include "io/json.hpp"
#include "io/report_data.hpp"
#include "io/report_histories.hpp"
#include "io/report_still.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace grandamp::report {
namespace {

/// Granules times pictures that a page carries; more snapshots are left out evenly.
constexpr std::size_t most_places = 3'000'000;
/// Colours are scaled so that few granules are beyond the end of the scale.
constexpr double within_scale = 0.998;

struct Frames {
  std::vector<double> times;
  std::size_t taken = 0; ///< snapshots of the run
  Snapshot last;
  Extent extent;
  std::vector<std::uint16_t> places;
  std::vector<float> speeds, spins;
  std::vector<std::uint8_t> contacts;
  std::vector<std::vector<std::string>> numbers;
};

double magnitude(const Vector3& v) {
  return std::hypot(v[0], v[1], v[2]);
}

/// Which of so many snapshots to take: the first and the last, and evenly between.
std::vector<std::size_t> chosen(std::size_t snapshots, std::size_t granules) {
  const std::size_t most = std::max<std::size_t>(2, most_places / std::max<std::size_t>(granules, 1));
  std::vector<std::size_t> indices;
  if (snapshots <= most) {
    for (std::size_t k = 0; k < snapshots; ++k) indices.push_back(k);
    return indices;
  }
  for (std::size_t k = 0; k < most; ++k) indices.push_back(k * (snapshots - 1) / (most - 1));
  return indices;
}

void take(Frames& frames, const Snapshot& snapshot) {
  const GranuleTable& table = snapshot.table;
  double sum = 0.0, fastest = 0.0, contacts = 0.0;
  for (std::size_t id = 0; id < table.position.size(); ++id) {
    for (std::size_t k = 0; k < 3; ++k)
      frames.places.push_back(
          quantised(table.position[id][k], frames.extent.low[k], frames.extent.low[k] + frames.extent.size[k], 65535));
    const double speed = magnitude(table.velocity[id]);
    frames.speeds.push_back(static_cast<float>(speed));
    frames.spins.push_back(static_cast<float>(magnitude(table.spin[id])));
    frames.contacts.push_back(static_cast<std::uint8_t>(std::clamp(table.contacts[id], 0, 255)));
    sum += speed;
    fastest = std::max(fastest, speed);
    contacts += table.contacts[id];
  }
  const auto count = static_cast<double>(table.position.size());
  frames.times.push_back(snapshot.time);
  frames.numbers.push_back({fmt::format("{:.5g}", snapshot.time), fmt::format("{:.4g}", sum / count),
                            fmt::format("{:.4g}", fastest), fmt::format("{:.3g}", contacts / count)});
}

/// All that granules may be at: a little more than the enclosure, so that those that press into a wall are not held.
Extent roomy(const Enclosure& enclosure) {
  Extent extent = extent_of(enclosure);
  for (std::size_t k = 0; k < 3; ++k) {
    extent.low[k] -= 0.05 * extent.size[k];
    extent.size[k] *= 1.1;
  }
  return extent;
}

std::optional<Frames> frames_of(const RunFacts& run) {
  Frames frames;
  frames.extent = roomy(run.scene->enclosure);
  const std::filesystem::path results = run.folder / "results.h5";
  const SnapshotReader snapshots(results);
  if (snapshots.times().empty()) {
    if (run.summary.is_null() || text(run.summary, "status") != "done") return std::nullopt;
    frames.last = read_final_granules(results);
    if (frames.last.table.position.empty()) return std::nullopt;
    take(frames, frames.last);
    return frames;
  }
  frames.taken = snapshots.times().size();
  frames.last = snapshots.read(frames.taken - 1);
  if (frames.last.table.position.empty()) return std::nullopt;
  for (const std::size_t index : chosen(frames.taken, frames.last.table.position.size()))
    take(frames, snapshots.read(index));
  return frames;
}

double end_of_scale(std::vector<float> values) {
  const auto place = static_cast<std::ptrdiff_t>(within_scale * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return static_cast<double>(values[static_cast<std::size_t>(place)]);
}

std::vector<std::uint8_t> shades(const std::vector<float>& values, double end) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size());
  for (const float value : values)
    bytes.push_back(static_cast<std::uint8_t>(quantised(static_cast<double>(value), 0.0, end, 255)));
  return bytes;
}

Json smooth_way(const char* name, const char* label, const std::string& to) {
  return {{"name", name}, {"label", label}, {"smooth", true}, {"colours", colour_scale()}, {"from", "0"}, {"to", to}};
}

void add_populations(Page& page, Json& ways, const RunFacts& run, const Frames& frames) {
  static constexpr std::array colours{colour::blue, colour::orange, colour::green, colour::vermilion,
                                      colour::sky,  colour::purple, colour::grey};
  const std::size_t populations = run.scene->populations.size();
  if (populations < 2) return;
  Json way{{"name", "population"}, {"label", "population"}, {"smooth", false}};
  for (std::size_t k = 0; k < populations; ++k) {
    const std::string& name = run.scene->populations[k].name;
    way["colours"].push_back(colours[k % colours.size()]);
    way["names"].push_back(name.empty() ? fmt::format("population {}", k) : name);
  }
  std::vector<std::uint8_t> bytes;
  for (const std::int32_t population : frames.last.table.population) // the middle of its share of the texture
    bytes.push_back(static_cast<std::uint8_t>((population + 0.5) / static_cast<double>(populations) * 255.0));
  page.add_data("shade-population", bytes_of(bytes));
  ways.push_back(std::move(way));
}

Json ways_of(Page& page, const RunFacts& run, const Frames& frames, double fastest) {
  Json ways = Json::array();
  ways.push_back(smooth_way("speed", "speed", readable(fastest, "m/s", 3) + " and more"));
  page.add_data("shade-speed", bytes_of(shades(frames.speeds, fastest)));
  add_populations(page, ways, run, frames);
  const int most = std::max<int>(1, *std::max_element(frames.contacts.begin(), frames.contacts.end()));
  ways.push_back(smooth_way("contacts", "contacts", fmt::format("{} contacts", most)));
  page.add_data("shade-contacts", bytes_of(shades({frames.contacts.begin(), frames.contacts.end()}, most)));
  if (const double spin = end_of_scale(frames.spins); spin > 0.0) {
    ways.push_back(smooth_way("spin", "spin", readable(spin, "rad/s", 3) + " and more"));
    page.add_data("shade-spin", bytes_of(shades(frames.spins, spin)));
  }
  return ways;
}

/// Where the enclosure was at those times.
std::vector<double> displacements(const RunFacts& run, const std::vector<double>& times) {
  const std::vector<double>&rows = *run.column("time"), &x = *run.column("displacement");
  std::vector<double> at;
  for (const double time : times) {
    const auto next = std::lower_bound(rows.begin(), rows.end(), time - 1e-12);
    at.push_back(x[std::min(static_cast<std::size_t>(next - rows.begin()), x.size() - 1)]);
  }
  return at;
}

} // namespace

void add_granules(Page& page, const RunFacts& run) {
  if (!run.scene || (run.plan && run.plan->granules == 0)) return;
  const std::optional<Frames> frames = frames_of(run);
  if (!frames) return;
  const GranuleTable& table = frames->last.table;
  page.section("granules", "The granules");
  const double fastest = end_of_scale(frames->speeds);
  Json live{{"kind", "granules"},
            {"count", table.position.size()},
            {"frames", frames->times.size()},
            {"times", frames->times}};
  live["low"] = frames->extent.low;
  live["span"] = frames->extent.size;
  const Extent enclosure = extent_of(run.scene->enclosure);
  live["enclosure"] = {{"low", enclosure.low}, {"size", enclosure.size}};
  live["edges"] = Json::array();
  for (const Vector3& point : edges_of(run.scene->enclosure))
    for (const double coordinate : point) live["edges"].push_back(coordinate);
  live["ways"] = ways_of(page, run, *frames, fastest);
  const std::vector<double> moved = displacements(run, frames->times);
  const bool led = run.scene->excitation.kind == ExcitationKind::prescribed;
  live["direction"] = run.scene->structure ? run.scene->structure->direction : run.scene->excitation.direction;
  if ((run.scene->structure || led) && std::any_of(moved.begin(), moved.end(), [](double x) { return x != 0.0; }))
    live["displacement"] = moved;
  page.add_data("places", bytes_of(frames->places));
  page.add_data("radii", bytes_of(as_floats(table.radius)));

  std::vector<std::string> colours;
  for (const Vector3& velocity : table.velocity) colours.push_back(scale_colour(magnitude(velocity) / fastest));
  std::string caption = "Positions are in the enclosure's frame, to 1/60,000 of its size; speeds in the laboratory's.";
  if (frames->taken > frames->times.size())
    caption += fmt::format(" {} of the run's {} snapshots, evenly.", frames->times.size(), frames->taken);
  if (frames->taken == 0)
    caption += " The run took no snapshots (output.snapshot_interval): these are the granules at its end.";
  const std::string title = fmt::format("{} granules at {:.4g} s, by speed, up to {}", table.position.size(),
                                        frames->last.time, readable(fastest, "m/s", 3));
  page.add(Figure{
      "granules_picture", frames->taken > 0 ? "Granules in the enclosure" : "Granules in the enclosure, at the end",
      caption, granules_picture(title, run.scene->enclosure, table.position, table.radius, colours), std::move(live),
      report::table({"time, s", "mean speed, m/s", "fastest, m/s", "contacts per granule"}, frames->numbers)});
}

} // namespace grandamp::report
