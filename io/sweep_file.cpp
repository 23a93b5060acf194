#include "io/hdf5.hpp"
#include "io/sweep_table.hpp"
#include "io/version.hpp"

#include <cmath>
#include <limits>

namespace grandamp {

void SweepTable::write_hdf5() const {
  const hdf5::Silence silence;
  hdf5::File file = hdf5::File::create(folder / "sweep.h5");
  file.set_attribute("/", "program", std::string("grandamp"));
  file.set_attribute("/", "content", std::string("sweep"));
  file.set_attribute("/", "format_version", std::int64_t{1});
  file.set_attribute("/", "version", version());
  file.write("/scene", scene_text);

  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  file.create_group("/values");
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i].numeric()) {
      std::vector<double> values;
      for (const CasePoint& point : points) values.push_back(*point.values[i].number);
      file.write("/values/" + keys[i].key, values);
    } else {
      std::string lines;
      for (const CasePoint& point : points) lines += point.values[i].text + '\n';
      file.write("/values/" + keys[i].key, lines);
    }
  }
  std::vector<std::int64_t> done, granules, seed_numbers;
  for (std::size_t k = 0; k < points.size(); ++k) {
    done.push_back(static_cast<std::int64_t>(results[k].done));
    granules.push_back(static_cast<std::int64_t>(points[k].granules));
  }
  for (std::size_t seed = 0; seed < seeds; ++seed) seed_numbers.push_back(static_cast<std::int64_t>(run(0, seed).seed));
  file.write("/done", done);
  file.write("/granules", granules);
  file.write("/seeds", seed_numbers);

  for (const char* group : {"/mean", "/error", "/runs"}) file.create_group(group);
  for (const std::string& one : names) {
    std::vector<double> mean, error, each;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const MeanAndError* found = results[k].find(one);
      mean.push_back(found != nullptr ? found->mean : nothing);
      error.push_back(found != nullptr ? found->error : nothing);
      for (std::size_t seed = 0; seed < seeds; ++seed) each.push_back(run(k, seed).numbers.at(one));
    }
    file.write("/mean/" + one, mean);
    file.write("/error/" + one, error);
    file.write("/runs/" + one, each, seeds);
  }
  file.close();
}

} // namespace grandamp
