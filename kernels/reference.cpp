#include "kernels/reference.hpp"

#include <algorithm>
#include <cmath>

namespace grandamp::reference {

namespace {

Vector operator+(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vector operator*(double s, const Vector& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vector& a) {
  return std::sqrt(dot(a, a));
}

/// v_t = v - (v.n) n + (a_i w_i + a_j w_j) x n
Vector slip_velocity(const Vector& relative_velocity, const Vector& rolling, const Vector& normal) {
  return relative_velocity - dot(relative_velocity, normal) * normal + cross(rolling, normal);
}

/// The spring's new force: turned with the contact, eased with the overlap, loaded by the slip `drift`, held by the
/// slider.
Vector spring_force(const Contact& contact, const Spring& before, const Vector& drift, double stiffness, double most,
                    double step) {
  Vector force = before.force - dot(before.force, contact.normal) * contact.normal;
  const double turned = length(force);
  if (turned > 0.0) force = (length(before.force) / turned) * force;
  double time = step;
  if (before.overlap > 0.0)
    force = std::sqrt(std::min(1.0, contact.overlap / before.overlap)) * force;
  else if (contact.approach * step > contact.overlap)
    time = contact.overlap / contact.approach; // in touch for a part of the step only
  force = force - (stiffness * std::sqrt(contact.overlap) * time) * drift;
  const double size = length(force);
  return size > most ? (most / size) * force : force;
}

/// The laws, once overlap, normal, approach, slip and arms are known.
void apply_laws(Contact& contact, double reduced_radius, double damping_mass, double slip_mass, int touching,
                const Law& law, double step, const Spring& before, const Vector& drift) {
  const double stiffness = law.stiffness_coefficient * std::sqrt(reduced_radius); // k_n, Eqs. (4), (5)
  contact.spring = stiffness * std::pow(contact.overlap, 1.5);                    // Eq. (2)
  contact.elastic_energy = 0.4 * stiffness * std::pow(contact.overlap, 2.5);
  if (law.damping == Damping::tsuji) // Eq. (6)
    contact.damping =
        law.alpha * std::sqrt(damping_mass * stiffness) * std::pow(contact.overlap, 0.25) * contact.approach;
  else if (law.damping == Damping::linear)
    contact.damping = law.normal_damping * contact.approach;
  if (!law.tension) contact.damping = std::max(contact.damping, -contact.spring);
  const double normal_force = contact.spring + contact.damping;
  contact.force_i = -normal_force * contact.normal;

  const double slip_speed = length(contact.slip);
  const double sliding = law.friction * std::abs(normal_force); // Eq. (7)
  if (law.spring) {
    const double tangential = law.tangential_stiffness_coefficient * std::sqrt(reduced_radius);
    contact.memory = {spring_force(contact, before, drift, tangential, sliding, step), contact.overlap};
    const double stored = dot(contact.memory.force, contact.memory.force);
    if (stored > 0.0) contact.spring_energy = 0.5 * stored / (tangential * std::sqrt(contact.overlap));
    contact.friction = contact.memory.force - law.tangential_damping * contact.slip;
    const double size = length(contact.friction);
    if (size > sliding) contact.friction = (sliding / size) * contact.friction;
  } else if (law.coulomb && slip_speed > 0.0) {
    const double tangential_mass = law.rotation ? 2.0 / 7.0 * slip_mass : slip_mass;
    const double bound = law.cap / (1.0 + std::max(touching, 1)) * tangential_mass * slip_speed / step;
    contact.friction = -(std::min(sliding, bound) / slip_speed) * contact.slip;
  } else {
    return;
  }
  contact.force_i = contact.force_i + contact.friction;
  if (!law.rotation) return;
  const Vector turning = cross(contact.normal, contact.friction);
  contact.torque_i = contact.arm_i * turning;
  contact.torque_j = contact.arm_j * turning;
}

Vector rolling_of(const Contact& contact, const Vector& spin_i, const Vector& spin_j, const Law& law) {
  if (!law.rotation) return {};
  return contact.arm_i * spin_i + contact.arm_j * spin_j;
}

Dissipation dissipation(const Contact& contact, const Vector& relative_velocity, const Vector& rolling) {
  const Vector slip = slip_velocity(relative_velocity, rolling, contact.normal);
  return {contact.damping * dot(relative_velocity, contact.normal), -dot(contact.friction, slip)};
}

} // namespace

Contact pair_contact(const Granule& i, const Granule& j, const Law& law, double step, const Spring& before,
                     const Arrival* arrival) {
  Contact contact;
  const Vector line = j.position - i.position;
  const double distance = length(line);
  const double overlap = i.radius + j.radius - distance;
  if (!(overlap > 0.0)) return contact;

  contact.touching = true;
  contact.overlap = overlap;
  contact.normal = (1.0 / distance) * line;
  contact.arm_i = i.radius * distance / (i.radius + j.radius);
  contact.arm_j = j.radius * distance / (i.radius + j.radius);
  const Vector relative_velocity = i.velocity - j.velocity;
  contact.approach = dot(relative_velocity, contact.normal);
  contact.slip = slip_velocity(relative_velocity, rolling_of(contact, i.spin, j.spin, law), contact.normal);
  const double effective_mass = i.mass * j.mass / (i.mass + j.mass);
  Vector drift = contact.slip;
  if (arrival)
    drift = slip_velocity(arrival->velocity_i - arrival->velocity_j,
                          rolling_of(contact, arrival->spin_i, arrival->spin_j, law), contact.normal);
  apply_laws(contact, i.radius * j.radius / (i.radius + j.radius), effective_mass, effective_mass,
             std::max(i.touching, j.touching), law, step, before, drift);
  return contact;
}

Contact wall_contact(const Granule& granule, double distance, const Vector& outward, const Law& law, double step,
                     double damping_mass, double slip_mass, const Spring& before, const Arrival* arrival) {
  Contact contact;
  const double overlap = granule.radius - distance;
  if (!(overlap > 0.0)) return contact;

  contact.touching = true;
  contact.overlap = overlap;
  contact.normal = outward;
  contact.arm_i = granule.radius - overlap;
  contact.approach = dot(granule.velocity, outward);
  contact.slip = slip_velocity(granule.velocity, rolling_of(contact, granule.spin, {}, law), outward);
  Vector drift = contact.slip;
  if (arrival)
    drift = slip_velocity(arrival->velocity_i, rolling_of(contact, arrival->spin_i, {}, law), contact.normal);
  apply_laws(contact, granule.radius, damping_mass, slip_mass, granule.touching, law, step, before, drift);
  return contact;
}

Dissipation pair_dissipation(const Contact& contact, const Granule& i, const Granule& j, const Law& law) {
  return dissipation(contact, i.velocity - j.velocity, rolling_of(contact, i.spin, j.spin, law));
}

Dissipation wall_dissipation(const Contact& contact, const Granule& granule, const Law& law) {
  return dissipation(contact, granule.velocity, rolling_of(contact, granule.spin, {}, law));
}

std::vector<WallPoint> box_walls(const Vector& size, const Vector& point) {
  std::vector<WallPoint> walls;
  for (std::size_t k = 0; k < 3; ++k) {
    Vector outward{};
    outward[k] = -1.0;
    walls.push_back({point[k], outward});
    outward[k] = 1.0;
    walls.push_back({size[k] - point[k], outward});
  }
  return walls;
}

std::vector<WallPoint> cylinder_walls(double diameter, double height, int axis, const Vector& point) {
  std::vector<WallPoint> walls;
  const auto along = static_cast<std::size_t>(axis);
  Vector from_axis{};
  for (std::size_t k = 0; k < 3; ++k)
    if (k != along) from_axis[k] = point[k] - 0.5 * diameter;
  const double radial = length(from_axis);
  if (radial > 0.0) walls.push_back({0.5 * diameter - radial, (1.0 / radial) * from_axis});
  Vector outward{};
  outward[along] = -1.0;
  walls.push_back({point[along], outward});
  outward[along] = 1.0;
  walls.push_back({height - point[along], outward});
  return walls;
}

double wall_effective_mass(double mass, const Vector& outward, const Vector& direction, double structure_mass) {
  const double along = dot(outward, direction);
  return 1.0 / (1.0 / mass + along * along / structure_mass);
}

void move(Granule& granule, const Vector& force, const Vector& torque, const Vector& gravity, const Vector& frame_kick,
          double step) {
  granule.velocity = granule.velocity + step * ((1.0 / granule.mass) * force + gravity) - frame_kick;
  granule.spin = granule.spin + (step / moment_of_inertia(granule)) * torque;
  granule.position = granule.position + step * granule.velocity;
}

double moment_of_inertia(const Granule& granule) {
  return 0.4 * granule.mass * granule.radius * granule.radius;
}

double kinetic_energy(const Granule& granule) {
  return 0.5 * granule.mass * dot(granule.velocity, granule.velocity) +
         0.5 * moment_of_inertia(granule) * dot(granule.spin, granule.spin);
}

} // namespace grandamp::reference
