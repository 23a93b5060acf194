// What tells a person of a file: shapes, types, attributes.
#include "io/hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grandamp::hdf5 {
namespace {

std::string type_name(hid_t type) {
  const std::size_t bits = 8 * H5Tget_size(type);
  switch (H5Tget_class(type)) {
  case H5T_FLOAT:
    return fmt::format("float{}", bits);
  case H5T_INTEGER:
    return fmt::format("{}int{}", H5Tget_sign(type) == H5T_SGN_NONE ? "u" : "", bits);
  case H5T_STRING:
    return "text";
  default:
    return "other";
  }
}

/// Of one value: a number or a text of fixed length.
std::string value_text(const Handle& attribute) {
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (!type || !space || H5Sget_simple_extent_npoints(space.id()) != 1) return "?";
  if (H5Tget_class(type.id()) == H5T_FLOAT) {
    double value = 0.0;
    return H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &value) < 0 ? "?" : fmt::format("{}", value);
  }
  if (H5Tget_class(type.id()) == H5T_INTEGER) {
    std::int64_t value = 0;
    return H5Aread(attribute.id(), H5T_NATIVE_INT64, &value) < 0 ? "?" : fmt::format("{}", value);
  }
  if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0) return "?";
  std::string text(H5Tget_size(type.id()), '\0');
  if (H5Aread(attribute.id(), type.id(), text.data()) < 0) return "?";
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

} // namespace

std::optional<Dataset> File::dataset(const std::string& name) const {
  const Silence silence;
  if (!has(name)) return std::nullopt;
  const Handle opened(H5Dopen2(file_.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!opened) return std::nullopt;
  Dataset dataset;
  const Handle type = owned(H5Dget_type(opened.id()), H5Tclose, "read " + name);
  dataset.type = type_name(type.id());
  const Handle space = owned(H5Dget_space(opened.id()), H5Sclose, "read " + name);
  std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space.id()))));
  if (!shape.empty()) require(H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr), "read " + name);
  dataset.shape.assign(shape.begin(), shape.end());
  for (const auto& [attribute, value] : attributes(name)) {
    if (attribute == "units") dataset.units = value;
    if (attribute == "description") dataset.description = value;
  }
  return dataset;
}

std::vector<std::pair<std::string, std::string>> File::attributes(const std::string& object) const {
  const Silence silence;
  const Handle target = owned(H5Oopen(file_.id(), object.c_str(), H5P_DEFAULT), H5Oclose, "read " + object);
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* data) -> herr_t {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    return 0;
  };
  require(H5Aiterate2(target.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names),
          "list the attributes of " + object);
  std::vector<std::pair<std::string, std::string>> attributes;
  for (const std::string& name : names) {
    const Handle attribute =
        owned(H5Aopen(target.id(), name.c_str(), H5P_DEFAULT), H5Aclose, "read the attribute " + name);
    attributes.emplace_back(name, value_text(attribute));
  }
  return attributes;
}

} // namespace grandamp::hdf5
