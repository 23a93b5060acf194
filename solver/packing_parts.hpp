// The pieces of packing: the room that centres may take, random places, places on a loose lattice.
#pragma once

#include "solver/random_numbers.hpp"
#include "solver/sphere_grid.hpp"

#include <functional>
#include <vector>

namespace grandamp::packing {

/// Where centres of spheres may be inside an enclosure.
class Room {
public:
  explicit Room(const Enclosure& enclosure);

  const Vector3& box() const noexcept { return box_; }
  double volume() const noexcept { return volume_; } ///< m^3
  /// From a point to the nearest wall, m; negative outside.
  double to_wall(const Vector3& p) const;
  /// The nearest point at which a sphere is inside; the middle where it does not fit.
  Vector3 confined(const Vector3& p, double radius) const;
  Vector3 random_place(RandomNumbers& random, double radius) const;

private:
  bool cylinder_;
  std::size_t axis_;
  double diameter_;
  Vector3 box_;
  double volume_;
};

/// Spheres to be placed, those of `placed` being where they must stay.
struct Spheres {
  std::vector<Vector3> position;
  std::vector<double> radius;
  std::vector<char> placed;
};

/// Anywhere without overlaps: one after the other where that is easy, else from random points by pushing overlaps
/// apart. False if there is no room. `pulse`, if given, is called now and then; what it throws ends the search.
bool place_at_random(const Room& room, Spheres& spheres, RandomNumbers& random, const std::function<void()>& pulse);

/// On the sites of a hexagonal close packing, those that are left over empty at random: for enclosures too full for
/// random places. False (and nothing is placed) if there are too few sites.
bool place_on_close_packing(const Room& room, Spheres& spheres, RandomNumbers& random);

/// On a jittered lattice, the lowest sites first, sizes mixed. False (and nothing is placed) if that takes more room
/// than there is.
bool place_on_lattice(const Room& room, const Vector3& gravity, Spheres& spheres, RandomNumbers& random);

} // namespace grandamp::packing
