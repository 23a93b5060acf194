#include "io/version.hpp"

#include "kernels/dispatch.hpp"

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <fmt/format.h>
#include <hdf5.h>
#include <nlohmann/json.hpp>
#include <spdlog/version.h>
#include <tbb/version.h>
#include <toml++/impl/version.h>

#include <vector>

namespace grandamp {
namespace {

std::vector<std::string> built_in() {
  std::vector<std::string> names{"generic"};
#ifdef GRANDAMP_HAVE_AVX2
  names.emplace_back("avx2");
#endif
#ifdef GRANDAMP_HAVE_AVX512
  names.emplace_back("avx512");
#endif
  return names;
}

std::vector<std::string> usable() {
  using kernels::InstructionSet;
  std::vector<std::string> names;
  for (const InstructionSet set : {InstructionSet::generic, InstructionSet::avx2, InstructionSet::avx512}) {
    if (kernels::available(set)) names.emplace_back(kernels::name(set));
  }
  return names;
}

std::string hdf5_version() {
  unsigned major = 0;
  unsigned minor = 0;
  unsigned release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

} // namespace

std::string version() {
  return GRANDAMP_VERSION;
}

std::string version_report() {
  std::string report = fmt::format("grandamp {}\n", version());
  report += fmt::format("compiler: {}\n", GRANDAMP_COMPILER);
  report +=
      fmt::format("instruction sets: built in {}; usable on this machine {}; default {}\n", fmt::join(built_in(), ", "),
                  fmt::join(usable(), ", "), kernels::name(kernels::best_available()));
  report +=
      fmt::format("libraries: CLI11 {}, Eigen {}.{}.{}, fmt {}.{}.{}, HDF5 {}, nlohmann-json {}.{}.{}, "
                  "oneTBB {}, spdlog {}.{}.{}, toml++ {}.{}.{}",
                  CLI11_VERSION, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, FMT_VERSION / 10000,
                  FMT_VERSION / 100 % 100, FMT_VERSION % 100, hdf5_version(), NLOHMANN_JSON_VERSION_MAJOR,
                  NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH, TBB_runtime_version(), SPDLOG_VER_MAJOR,
                  SPDLOG_VER_MINOR, SPDLOG_VER_PATCH, TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH);
  return report;
}

} // namespace grandamp
