#include "solver/packing_parts.hpp"

#include "solver/measures.hpp"

#include <numeric>

namespace grandamp::packing {

namespace {

/// A simple cubic lattice that fills the box from wall to wall, for spheres of one radius.
class Lattice {
public:
  Lattice(const Vector3& box, double radius, double spacing) : radius_(radius) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double free = box[k] - 2.0 * radius;
      sites_[k] = 1 + static_cast<std::int64_t>(std::floor(free / spacing));
      spacing_[k] = sites_[k] > 1 ? free / static_cast<double>(sites_[k] - 1) : 0.0;
      first_[k] = sites_[k] > 1 ? radius : 0.5 * box[k];
    }
  }

  std::int64_t sites(std::size_t k) const { return sites_[k]; }
  double spacing(std::size_t k) const { return spacing_[k]; }
  double at(std::size_t k, std::int64_t site) const { return first_[k] + static_cast<double>(site) * spacing_[k]; }
  /// How far a sphere may stray from its site along k without reaching a neighbour that strays as well.
  double play(std::size_t k) const { return sites_[k] > 1 ? 0.49 * (spacing_[k] - 2.0 * radius_) : 0.0; }

private:
  double radius_;
  std::int64_t sites_[3];
  Vector3 spacing_{};
  Vector3 first_{};
};

struct Site {
  double height; ///< against gravity
  Vector3 position;
};

Vector3 up_of(const Vector3& gravity) {
  const double length = norm(gravity);
  if (length == 0.0) return {0.0, 0.0, 1.0};
  return {-gravity[0] / length, -gravity[1] / length, -gravity[2] / length};
}

double along(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Height of the box's lowest corner.
double lowest_corner(const Vector3& box, const Vector3& up) {
  return std::min(0.0, box[0] * up[0]) + std::min(0.0, box[1] * up[1]) + std::min(0.0, box[2] * up[2]);
}

/// Sites no higher than `top` above the lowest corner. Columns run along the axis nearest to gravity, and only their
/// lower part is walked: a shallow bed in a tall enclosure costs what the bed costs.
std::vector<Site> sites_below(const Room& room, const Lattice& lattice, const Vector3& up, double radius, double top) {
  std::size_t main = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(up[k]) > std::abs(up[main])) main = k;
  const std::size_t a = (main + 1) % 3, b = (main + 2) % 3;
  const double limit = lowest_corner(room.box(), up) + top;
  std::vector<Site> sites;
  for (std::int64_t i = 0; i < lattice.sites(a); ++i)
    for (std::int64_t j = 0; j < lattice.sites(b); ++j)
      for (std::int64_t k = 0; k < lattice.sites(main); ++k) {
        Site site;
        site.position[a] = lattice.at(a, i);
        site.position[b] = lattice.at(b, j);
        site.position[main] = lattice.at(main, up[main] > 0.0 ? k : lattice.sites(main) - 1 - k);
        site.height = along(site.position, up);
        if (site.height > limit) break;
        if (room.to_wall(site.position) >= radius) sites.push_back(site);
      }
  return sites;
}

/// Spheres smaller than half the largest find room between: the larger ones are strewn in the part of the enclosure
/// that the bed will take, the smallest then fill the lattice around them.
bool strew(const Room& room, const Vector3& up, double top, Spheres& spheres, const std::vector<std::size_t>& which,
           SphereGrid& grid, RandomNumbers& random) {
  const double limit = lowest_corner(room.box(), up) + top;
  for (const std::size_t i : which) {
    bool found = false;
    for (int k = 0; k < 20000 && !found; ++k) {
      spheres.position[i] = room.random_place(random, spheres.radius[i]);
      found = along(spheres.position[i], up) <= limit && grid.is_free(spheres.position[i], spheres.radius[i]);
    }
    if (!found) return false;
    grid.insert(i);
  }
  return true;
}

bool fill(const Room& room, const Vector3& up, Spheres& spheres, std::vector<std::size_t> which, const SphereGrid& grid,
          bool obstacles, RandomNumbers& random, double loose) {
  double radius = 0.0;
  for (const std::size_t i : which) radius = std::max(radius, spheres.radius[i]);
  const Lattice lattice(room.box(), radius, 2.0 * radius * loose);
  double extent = 0.0;
  for (std::size_t k = 0; k < 3; ++k) extent += room.box()[k] * std::abs(up[k]);
  const double cell = 8.0 * radius * radius * radius * loose * loose * loose;
  const double volume = room.box()[0] * room.box()[1] * room.box()[2];
  double top = 4.0 * radius + 1.1 * extent * static_cast<double>(which.size()) * cell / volume;
  std::vector<Site> sites;
  for (;; top *= 1.5) {
    sites = sites_below(room, lattice, up, radius, top);
    if (obstacles) std::erase_if(sites, [&](const Site& site) { return !grid.is_free(site.position, radius); });
    if (sites.size() >= which.size()) break;
    if (top >= extent) return false;
  }
  std::stable_sort(sites.begin(), sites.end(), [](const Site& x, const Site& y) { return x.height < y.height; });
  random.shuffle(which); // which sphere goes where: a mixture is a mixture
  for (std::size_t n = 0; n < which.size(); ++n) {
    const std::size_t i = which[n];
    Vector3 p = sites[n].position;
    // Jitter breaks the lattice's order, within the play: it never overlaps what stands on the next site.
    for (std::size_t k = 0; k < 3; ++k) p[k] += random.uniform(-1.0, 1.0) * lattice.play(k);
    p = room.confined(p, spheres.radius[i]);
    if (obstacles && !grid.is_free(p, spheres.radius[i])) p = sites[n].position;
    spheres.position[i] = p;
  }
  return true;
}

/// Centres of a hexagonal close packing in the room: rows along one axis, layers stacked along another. The layers
/// are spread evenly from wall to wall.
std::vector<Vector3> close_packing(const Room& room, double radius, std::size_t rows, std::size_t layers) {
  const std::size_t across = 3 - rows - layers;
  const double diameter = 2.0 * radius * (1.0 + 1.0e-9);
  const auto spread = [&](std::size_t k, double pitch) {
    const double free = room.box()[k] - diameter;
    const double gaps = std::max(0.0, std::floor(free / pitch));
    return std::pair{static_cast<int>(gaps) + 1, gaps > 0.0 ? free / gaps : 0.0};
  };
  const auto [layer_count, layer_pitch] = spread(layers, diameter * std::sqrt(2.0 / 3.0));
  // The spheres of every second layer sit in the hollows of the others, a third of the rows' distance further.
  const double row_pitch = diameter * std::sqrt(0.75), shift = row_pitch / 3.0;
  const double free_across = room.box()[across] - diameter, free_along = room.box()[rows] - diameter;
  std::vector<Vector3> centres;
  for (int layer = 0; layer < layer_count; ++layer) {
    const double first_row = layer % 2 == 0 ? 0.0 : shift;
    for (int row = 0; first_row + row * row_pitch <= free_across; ++row) {
      const double first = (row + layer) % 2 == 0 ? 0.0 : 0.5 * diameter;
      for (int place = 0; first + place * diameter <= free_along; ++place) {
        Vector3 p{};
        p[layers] = 0.5 * diameter + layer * layer_pitch;
        p[across] = 0.5 * diameter + first_row + row * row_pitch;
        p[rows] = 0.5 * diameter + first + place * diameter;
        if (room.to_wall(p) >= radius) centres.push_back(p);
      }
    }
  }
  return centres;
}

} // namespace

bool place_on_close_packing(const Room& room, Spheres& spheres, RandomNumbers& random) {
  std::vector<std::size_t> free;
  double radius = 0.0;
  SphereGrid grid(room.box(), spheres.position, spheres.radius);
  for (std::size_t i = 0; i < spheres.radius.size(); ++i) {
    if (spheres.placed[i])
      grid.insert(i);
    else
      free.push_back(i);
    if (!spheres.placed[i]) radius = std::max(radius, spheres.radius[i]);
  }
  std::vector<Vector3> best;
  for (std::size_t rows = 0; rows < 3; ++rows)
    for (std::size_t layers = 0; layers < 3; ++layers) {
      if (rows == layers) continue;
      std::vector<Vector3> sites = close_packing(room, radius, rows, layers);
      std::erase_if(sites, [&](const Vector3& site) { return !grid.is_free(site, radius); });
      if (sites.size() > best.size()) best = std::move(sites);
    }
  if (best.size() < free.size()) return false;
  random.shuffle(best);
  for (std::size_t n = 0; n < free.size(); ++n) spheres.position[free[n]] = best[n];
  return true;
}

bool place_on_lattice(const Room& room, const Vector3& gravity, Spheres& spheres, RandomNumbers& random) {
  const Vector3 up = up_of(gravity);
  std::vector<std::size_t> free;
  double largest = 0.0, smallest = 0.0, solid = 0.0, extent = 0.0;
  for (std::size_t i = 0; i < spheres.radius.size(); ++i) {
    if (spheres.placed[i]) continue;
    free.push_back(i);
    largest = std::max(largest, spheres.radius[i]);
    smallest = smallest == 0.0 ? spheres.radius[i] : std::min(smallest, spheres.radius[i]);
    solid += sphere_volume(spheres.radius[i]);
  }
  if (free.empty()) return true;
  for (std::size_t k = 0; k < 3; ++k) extent += room.box()[k] * std::abs(up[k]);

  // Up to a ratio of 1.6 one lattice for all is loose enough; beyond, it would waste most of the room.
  std::vector<std::size_t> large, small;
  const double limit = largest > 1.6 * smallest ? 1.6 * smallest : largest;
  for (const std::size_t i : free) (spheres.radius[i] > limit ? large : small).push_back(i);
  std::stable_sort(large.begin(), large.end(),
                   [&](std::size_t a, std::size_t b) { return spheres.radius[a] > spheres.radius[b]; });

  const std::vector<Vector3> before = spheres.position;
  for (const double loose : {1.06, 1.02, 1.002}) {
    spheres.position = before;
    SphereGrid grid(room.box(), spheres.position, spheres.radius);
    bool obstacles = !large.empty();
    for (std::size_t i = 0; i < spheres.radius.size(); ++i)
      if (spheres.placed[i]) {
        grid.insert(i);
        obstacles = true;
      }
    const double bed = 4.0 * largest + extent * solid / (0.35 * room.box()[0] * room.box()[1] * room.box()[2]);
    if (strew(room, up, bed, spheres, large, grid, random) &&
        fill(room, up, spheres, small, grid, obstacles, random, loose))
      return true;
  }
  spheres.position = before;
  return false;
}

} // namespace grandamp::packing
