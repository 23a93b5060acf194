#include "io/report_still.hpp"

#include "io/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

namespace grandamp::report {
namespace {

constexpr double page_width = 640.0, page_height = 520.0, top = 36.0, margin = 14.0;

/// From a corner, a little from above; x to the right and y away on the picture, z nearer to the eye.
Vector3 turned(const Vector3& p) {
  const double azimuth = 0.53, elevation = 0.36;
  const double right = std::cos(azimuth) * p[0] + std::sin(azimuth) * p[1];
  const double away = -std::sin(azimuth) * p[0] + std::cos(azimuth) * p[1];
  return {right, std::sin(elevation) * away + std::cos(elevation) * p[2],
          -std::cos(elevation) * away + std::sin(elevation) * p[2]};
}

class Picture {
public:
  explicit Picture(const std::vector<Vector3>& edges) {
    std::array<double, 2> low{1e300, 1e300}, high{-1e300, -1e300};
    for (const Vector3& edge : edges) {
      const Vector3 p = turned(edge);
      for (std::size_t k = 0; k < 2; ++k) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
    }
    scale_ =
        std::min((page_width - 2.0 * margin) / (high[0] - low[0]), (page_height - top - margin) / (high[1] - low[1]));
    x_ = 0.5 * (page_width - scale_ * (low[0] + high[0]));
    y_ = 0.5 * (top + page_height - margin + scale_ * (low[1] + high[1]));
  }
  /// Pixels; the third is the distance towards the eye.
  Vector3 at(const Vector3& p) const {
    const Vector3 t = turned(p);
    return {x_ + scale_ * t[0], y_ - scale_ * t[1], scale_ * t[2]};
  }
  double scale() const { return scale_; }

private:
  double scale_ = 1.0, x_ = 0.0, y_ = 0.0;
};

/// Takes discs from the nearest on, and tells which still show.
class Cover {
public:
  Cover() : taken_(static_cast<std::size_t>(page_width * page_height), 0) {}
  bool shows(const Vector3& centre, double radius) {
    bool shown = false;
    const auto within = [](double value, double most) { return static_cast<int>(std::clamp(value, 0.0, most)); };
    const int y1 = within(centre[1] + radius + 1.0, page_height - 1.0),
              x1 = within(centre[0] + radius + 1.0, page_width - 1.0);
    for (int y = within(centre[1] - radius, page_height - 1.0); y <= y1; ++y)
      for (int x = within(centre[0] - radius, page_width - 1.0); x <= x1; ++x) {
        if (std::hypot(x - centre[0], y - centre[1]) > radius) continue;
        std::uint8_t& pixel =
            taken_[static_cast<std::size_t>(y) * static_cast<std::size_t>(page_width) + static_cast<std::size_t>(x)];
        shown = shown || pixel == 0;
        pixel = 1;
      }
    return shown || radius < 1.0;
  }

private:
  std::vector<std::uint8_t> taken_;
};

} // namespace

Extent extent_of(const Enclosure& enclosure) {
  if (enclosure.shape == EnclosureShape::box) return {{0.0, 0.0, 0.0}, enclosure.size};
  Vector3 size{enclosure.diameter, enclosure.diameter, enclosure.diameter};
  size[static_cast<std::size_t>(enclosure.axis)] = enclosure.height;
  return {{0.0, 0.0, 0.0}, size};
}

std::vector<Vector3> edges_of(const Enclosure& enclosure) {
  std::vector<Vector3> edges;
  const Vector3 size = extent_of(enclosure).size;
  if (enclosure.shape == EnclosureShape::box) {
    for (unsigned corner = 0; corner < 8; ++corner)
      for (unsigned axis = 0; axis < 3; ++axis) {
        if (corner >> axis & 1U) continue;
        for (const unsigned end : {corner, corner | 1U << axis})
          edges.push_back({end & 1U ? size[0] : 0.0, end & 2U ? size[1] : 0.0, end & 4U ? size[2] : 0.0});
      }
    return edges;
  }
  constexpr int sides = 96, lines = 8;
  const auto along = static_cast<std::size_t>(enclosure.axis), u = (along + 1) % 3, v = (along + 2) % 3;
  const auto rim = [&](double share, double level) {
    const double angle = 2.0 * std::numbers::pi * share, r = 0.5 * enclosure.diameter;
    Vector3 point{r, r, r};
    point[u] += r * std::cos(angle);
    point[v] += r * std::sin(angle);
    point[along] = level;
    return point;
  };
  for (const double level : {0.0, enclosure.height})
    for (int k = 0; k < sides; ++k) {
      edges.push_back(rim(static_cast<double>(k) / sides, level));
      edges.push_back(rim(static_cast<double>(k + 1) / sides, level));
    }
  for (int k = 0; k < lines; ++k)
    for (const double level : {0.0, enclosure.height}) edges.push_back(rim(static_cast<double>(k) / lines, level));
  return edges;
}

const std::vector<std::string>& colour_scale() {
  static const std::vector<std::string> colours{"#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c",
                                                "#28ae80", "#5ec962", "#addc30", "#fde725"};
  return colours;
}

std::string scale_colour(double share) {
  const std::vector<std::string>& colours = colour_scale();
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(colours.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), colours.size() - 2);
  std::string mixed = "#";
  for (std::size_t k = 1; k < 7; k += 2) {
    const auto part = [k](const std::string& colour) {
      return static_cast<double>(std::stoi(colour.substr(k, 2), nullptr, 16));
    };
    const double from = part(colours[below]), to = part(colours[below + 1]);
    mixed +=
        fmt::format("{:02x}", static_cast<int>(std::lround(from + (place - static_cast<double>(below)) * (to - from))));
  }
  return mixed;
}

std::string granules_picture(const std::string& title, const Enclosure& enclosure,
                             const std::vector<Vector3>& positions, const std::vector<double>& radii,
                             const std::vector<std::string>& colours) {
  const std::vector<Vector3> edges = edges_of(enclosure);
  const Picture picture(edges);
  std::string svg =
      fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0:g} {1:g}" width="{0:g}" height="{1:g}" )"
                  R"(font-family="sans-serif" font-size="13"><rect width="100%" height="100%" fill="white"/>)"
                  R"(<text x="{2:g}" y="20" text-anchor="middle">{3}</text>)"
                  "\n",
                  page_width, page_height, 0.5 * page_width, escaped(title));
  const auto line = [&](std::size_t k, const char* style) {
    const Vector3 a = picture.at(edges[k]), b = picture.at(edges[k + 1]);
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" {}/>\n", a[0], a[1], b[0], b[1], style);
  };
  for (std::size_t k = 0; k < edges.size(); k += 2) line(k, R"(stroke="#9aa5ad" stroke-width="1")");

  std::vector<std::size_t> order(positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<Vector3> places;
  places.reserve(positions.size());
  for (const Vector3& position : positions) places.push_back(picture.at(position));
  std::sort(order.begin(), order.end(),
            [&places](std::size_t a, std::size_t b) { return places[a][2] > places[b][2]; });
  Cover cover;
  std::vector<std::size_t> shown;
  for (const std::size_t id : order)
    if (cover.shows(places[id], radii[id] * picture.scale())) shown.push_back(id);
  svg += "<g stroke=\"#1d2429\" stroke-opacity=\"0.55\" stroke-width=\"0.6\">\n";
  for (auto id = shown.rbegin(); id != shown.rend(); ++id)
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\"/>\n", places[*id][0],
                       places[*id][1], radii[*id] * picture.scale(), colours[*id]);
  svg += "</g>\n";
  // What of the enclosure is on the near side, once more, faintly.
  const Vector3 middle = picture.at(
      {0.5 * extent_of(enclosure).size[0], 0.5 * extent_of(enclosure).size[1], 0.5 * extent_of(enclosure).size[2]});
  for (std::size_t k = 0; k < edges.size(); k += 2)
    if (picture.at(edges[k])[2] + picture.at(edges[k + 1])[2] > 2.0 * middle[2])
      line(k, R"(stroke="#5f6b76" stroke-width="1" stroke-opacity="0.6")");
  return svg + "</svg>\n";
}

} // namespace grandamp::report
