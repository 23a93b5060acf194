#include "io/xdmf.hpp"

#include "io/text_file.hpp"

#include <fmt/format.h>

namespace grandamp {
namespace {

/// Which part of a dataset with a row per snapshot is this snapshot's.
std::string row_of(const std::string& dataset, std::size_t row, std::size_t rows, std::size_t granules, bool vector,
                   bool whole_numbers) {
  const std::string number =
      whole_numbers ? R"(NumberType="Int" Precision="4")" : R"(NumberType="Float" Precision="8")";
  const auto shape = [&](std::size_t first) { return fmt::format("{} {}{}", first, granules, vector ? " 3" : ""); };
  const std::string zeros = vector ? " 0 0" : " 0", ones = vector ? " 1 1" : " 1";
  return fmt::format("<DataItem ItemType=\"HyperSlab\" Dimensions=\"{0}\">"
                     "<DataItem Dimensions=\"3 {1}\" Format=\"XML\">{2}{3} 1{4} {5}</DataItem>"
                     "<DataItem {6} Dimensions=\"{7}\" Format=\"HDF\">{8}</DataItem></DataItem>",
                     vector ? fmt::format("{} 3", granules) : fmt::format("{}", granules), vector ? 3 : 2, row, zeros,
                     ones, shape(1), number, shape(rows), dataset);
}

std::string attribute(const char* name, bool vector, const std::string& data) {
  return fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n", name,
                     vector ? "Vector" : "Scalar", data);
}

} // namespace

std::string xdmf_text(const std::string& results_name, const std::vector<double>& times, std::size_t granules) {
  const std::string data = results_name + ":/snapshots/";
  fmt::memory_buffer text;
  const auto add = [&text](const std::string& part) { text.append(part); };
  add("<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n"
      "    <Grid Name=\"granules\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto row = [&](const char* name, bool vector, bool whole_numbers) {
      return row_of(data + name, k, times.size(), granules, vector, whole_numbers);
    };
    add(fmt::format("      <Grid Name=\"granules\" GridType=\"Uniform\">\n        <Time Value=\"{:.17g}\"/>\n"
                    "        <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\"/>\n"
                    "        <Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                    times[k], granules, row("position", true, false)));
    add(attribute("radius", false,
                  fmt::format("<DataItem NumberType=\"Float\" Precision=\"8\" Dimensions=\"{}\" "
                              "Format=\"HDF\">{}radius</DataItem>",
                              granules, data)));
    add(attribute("population", false,
                  fmt::format("<DataItem NumberType=\"Int\" Precision=\"4\" Dimensions=\"{}\" "
                              "Format=\"HDF\">{}population</DataItem>",
                              granules, data)));
    add(attribute("speed", false, row("speed", false, false)));
    add(attribute("contacts", false, row("contacts", false, true)));
    add(attribute("velocity", true, row("velocity", true, false)));
    add(attribute("spin", true, row("spin", true, false)));
    add("      </Grid>\n");
  }
  add("    </Grid>\n  </Domain>\n</Xdmf>\n");
  return fmt::to_string(text);
}

void write_xdmf(const std::filesystem::path& path, const std::string& results_name, const std::vector<double>& times,
                std::size_t granules) {
  replace_file(path, xdmf_text(results_name, times, granules));
}

} // namespace grandamp
