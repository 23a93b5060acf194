#include "io/xdmf.hpp"

#include "io/text_file.hpp"

#include <fmt/format.h>

#include <string_view>

namespace grandamp {
namespace {

/// All the readers that ParaView offers for XDMF understand no more than whole datasets and an explicit topology.
class GridText {
public:
  GridText(std::string results_name, std::size_t granules)
      : data_(std::move(results_name) + ":/snapshots/"), granules_(granules) {}

  std::string of(std::size_t index, double time) const {
    const std::string group = fmt::format("{:06}/", index);
    return fmt::format("      <Grid Name=\"granules\" GridType=\"Uniform\">\n"
                       "        <Time Value=\"{:.17g}\"/>\n"
                       "        <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\">\n"
                       "          {}\n        </Topology>\n"
                       "        <Geometry GeometryType=\"XYZ\">\n          {}\n        </Geometry>\n",
                       time, granules_, item("id", whole, 8, " 1"), item(group + "position", real, 8, " 3")) +
           attribute("radius", "Scalar", item("radius", real, 8)) +
           attribute("speed", "Scalar", item(group + "speed", real, 8)) +
           attribute("velocity", "Vector", item(group + "velocity", real, 8, " 3")) +
           attribute("spin", "Vector", item(group + "spin", real, 8, " 3")) +
           attribute("population", "Scalar", item("population", whole, 4)) +
           attribute("contacts", "Scalar", item(group + "contacts", whole, 4)) + "      </Grid>\n";
  }

private:
  static constexpr std::string_view real = "Float", whole = "Int";

  std::string item(const std::string& name, std::string_view type, int bytes, std::string_view width = "") const {
    return fmt::format(R"(<DataItem NumberType="{}" Precision="{}" Dimensions="{}{}" Format="HDF">{}{}</DataItem>)",
                       type, bytes, granules_, width, data_, name);
  }
  static std::string attribute(std::string_view name, std::string_view type, const std::string& item) {
    return fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">\n          {}\n"
                       "        </Attribute>\n",
                       name, type, item);
  }

  std::string data_;
  std::size_t granules_;
};

} // namespace

void write_xdmf(const std::filesystem::path& path, const std::string& results_name, const std::vector<double>& times,
                std::size_t granules) {
  const GridText grid(results_name, granules);
  std::string text = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n"
                     "    <Grid Name=\"snapshots\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t k = 0; k < times.size(); ++k) text += grid.of(k, times[k]);
  text += "    </Grid>\n  </Domain>\n</Xdmf>\n";
  replace_file(path, text);
}

} // namespace grandamp
