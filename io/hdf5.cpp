#include "io/hdf5.hpp"

#include "io/hdf5_seal.hpp"
#include "solver/errors.hpp"

#include <algorithm>

namespace grandamp::hdf5 {
namespace {

constexpr std::size_t most_chunk_rows = 8192;

std::vector<hsize_t> shape_of(std::size_t values, std::size_t width) {
  std::vector<hsize_t> shape{values / width};
  if (width > 1) shape.push_back(width);
  return shape;
}

/// What HDF5's error stack says at its most specific level; the system's own words if they are in it.
std::string last_reason() {
  std::string reason;
  const auto first = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
    auto& text = *static_cast<std::string*>(data);
    if (text.empty() && error->desc != nullptr) text = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, first, &reason);
  static const std::string mark = "error message = '";
  if (const auto start = reason.find(mark); start != std::string::npos) {
    const auto begin = start + mark.size();
    return reason.substr(begin, reason.find('\'', begin) - begin);
  }
  return reason.empty() ? "unknown reason" : reason;
}

std::string message(const std::filesystem::path& path, const std::string& what) {
  return path.string() + ": cannot " + what + ": " + last_reason();
}

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), std::max<std::size_t>(length, 1));
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  return type;
}

} // namespace

Silence::Silence() {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Silence::~Silence() {
  H5Eset_auto2(H5E_DEFAULT, function_, data_);
}

File File::create(const std::filesystem::path& path) {
  const Silence silence;
  File created(path);
  created.output_.emplace(path);
  // Members listed in the order of their creation: a history's columns keep theirs.
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_link_creation_order(creation.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_userblock(creation.id(), seal_bytes);
  const Handle access(created.output_->access(), H5Pclose);
  // Quicker for many objects than the oldest format; HDF5 1.8 of 2008 reads it.
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_LATEST);
  created.file_ =
      Handle(H5Fcreate(created.output_->beside().c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  if (!created.file_) throw FileError(message(path, "create the file"));
  return created;
}

File File::open(const std::filesystem::path& path) {
  const SealReport seal = check_seal(path);
  if (seal.state == SealReport::State::damaged) throw FileError(path.string() + ": is damaged: " + seal.what);
  if (seal.state == SealReport::State::unsealed)
    throw FileError(path.string() + ": was not written by this program, or its start is damaged");
  return open_at_risk(path);
}

File File::open_at_risk(const std::filesystem::path& path) {
  const Silence silence;
  File opened(path);
  opened.file_ = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!opened.file_) throw FileError(message(path, "open the file"));
  return opened;
}

void File::fail(const std::string& what) const {
  throw FileError(message(path_, what));
}

Handle File::owned(hid_t id, Handle::Close how, const std::string& what) const {
  if (id < 0) fail(what);
  return Handle(id, how);
}

void File::require(herr_t status, const std::string& what) const {
  if (status < 0) fail(what);
}

void File::close() {
  const Silence silence;
  if (!file_.close()) fail("close the file");
  if (output_) output_->finish();
}

bool File::has(const std::string& name) const {
  const Silence silence;
  // Every group on the way must exist, or HDF5 calls the question itself an error.
  for (std::size_t slash = name.find('/', 1); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    if (H5Lexists(file_.id(), name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Lexists(file_.id(), name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> File::members(const std::string& group) const {
  const Silence silence;
  const Handle opened = owned(H5Gopen2(file_.id(), group.c_str(), H5P_DEFAULT), H5Gclose, "open " + group);
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    return 0;
  };
  if (H5Literate(opened.id(), H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, collect, &names) < 0) {
    names.clear();
    require(H5Literate(opened.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names), "list " + group);
  }
  return names;
}

void File::create_group(const std::string& name) {
  const Silence silence;
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_link_creation_order(creation.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  const Handle group =
      owned(H5Gcreate2(file_.id(), name.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Gclose, "create " + name);
}

Handle File::create_column(const std::string& name, std::size_t rows) {
  const Silence silence;
  const hsize_t start = 0;
  const hsize_t unlimited = H5S_UNLIMITED;
  // Short ones take little room, long ones few chunks.
  const hsize_t chunk = std::clamp<std::size_t>(rows, 1, most_chunk_rows);
  const Handle space = owned(H5Screate_simple(1, &start, &unlimited), H5Sclose, "create " + name);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  require(H5Pset_chunk(creation.id(), 1, &chunk), "create " + name);
  return owned(
      H5Dcreate2(file_.id(), name.c_str(), H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
      H5Dclose, "create " + name);
}

void File::append(const Handle& column, std::size_t rows_before, const std::vector<double>& values) {
  const Silence silence;
  const std::string what = "append to the file";
  const hsize_t start = rows_before;
  const hsize_t count = values.size();
  const hsize_t total = start + count;
  require(H5Dset_extent(column.id(), &total), what);
  const Handle target = owned(H5Dget_space(column.id()), H5Sclose, what);
  require(H5Sselect_hyperslab(target.id(), H5S_SELECT_SET, &start, nullptr, &count, nullptr), what);
  const Handle source = owned(H5Screate_simple(1, &count, nullptr), H5Sclose, what);
  require(H5Dwrite(column.id(), H5T_NATIVE_DOUBLE, source.id(), target.id(), H5P_DEFAULT, values.data()), what);
}

void File::write_values(const std::string& name, hid_t type, const void* data, const std::vector<hsize_t>& shape) {
  const Silence silence;
  const Handle space = shape.empty() ? owned(H5Screate(H5S_SCALAR), H5Sclose, "write " + name)
                                     : owned(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                                             H5Sclose, "write " + name);
  const Handle dataset =
      owned(H5Dcreate2(file_.id(), name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
            "write " + name);
  if (std::find(shape.begin(), shape.end(), hsize_t{0}) != shape.end()) return;
  require(H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "write " + name);
}

void File::write(const std::string& name, const std::vector<double>& values, std::size_t width) {
  write_values(name, H5T_NATIVE_DOUBLE, values.data(), shape_of(values.size(), width));
}

void File::write(const std::string& name, const std::vector<float>& values, std::size_t width) {
  write_values(name, H5T_NATIVE_FLOAT, values.data(), shape_of(values.size(), width));
}

void File::write(const std::string& name, const std::vector<std::int64_t>& values) {
  write_values(name, H5T_NATIVE_INT64, values.data(), {values.size()});
}

void File::write(const std::string& name, const std::vector<std::int32_t>& values) {
  write_values(name, H5T_NATIVE_INT32, values.data(), {values.size()});
}

void File::link(const std::string& object, const std::string& name) {
  const Silence silence;
  require(H5Lcreate_hard(file_.id(), object.c_str(), file_.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
          "write " + name);
}

void File::write(const std::string& name, const std::string& text) {
  const Handle type = text_type(text.size());
  write_values(name, type.id(), text.c_str(), {});
}

std::size_t File::count_of(const Handle& dataset, const std::string& name) const {
  const Handle space = owned(H5Dget_space(dataset.id()), H5Sclose, "read " + name);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  if (count < 0) fail("read " + name);
  // All that this program writes is there, value by value: a claim of more must not cost memory.
  const Handle type = owned(H5Dget_type(dataset.id()), H5Tclose, "read " + name);
  const auto points = static_cast<std::size_t>(count);
  if (points > 0 && points > H5Dget_storage_size(dataset.id()) / std::max<std::size_t>(1, H5Tget_size(type.id())))
    throw FileError(path_.string() + ": " + name + " claims more values than the file holds");
  return points;
}

void File::demand_one(const Handle& type, const Handle& space, H5T_class_t wanted, const std::string& name) const {
  const H5T_class_t is = H5Tget_class(type.id());
  const bool number = wanted == H5T_FLOAT && (is == H5T_FLOAT || is == H5T_INTEGER);
  const bool text = wanted == H5T_STRING && is == H5T_STRING && H5Tis_variable_str(type.id()) == 0;
  if ((!number && !text) || H5Sget_simple_extent_npoints(space.id()) != 1)
    throw FileError(path_.string() + ": " + name + " is not one " + (wanted == H5T_STRING ? "text" : "number"));
}

template <class Number> std::vector<Number> File::read_numbers(const std::string& name, hid_t type) const {
  const Silence silence;
  const Handle dataset = owned(H5Dopen2(file_.id(), name.c_str(), H5P_DEFAULT), H5Dclose, "read " + name);
  std::vector<Number> values(count_of(dataset, name));
  if (values.empty()) return values;
  require(H5Dread(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "read " + name);
  return values;
}

std::vector<double> File::read_doubles(const std::string& name) const {
  return read_numbers<double>(name, H5T_NATIVE_DOUBLE);
}

std::vector<float> File::read_floats(const std::string& name) const {
  return read_numbers<float>(name, H5T_NATIVE_FLOAT);
}

std::vector<std::int64_t> File::read_integers(const std::string& name) const {
  return read_numbers<std::int64_t>(name, H5T_NATIVE_INT64);
}

std::string File::read_text(const std::string& name) const {
  const Silence silence;
  const Handle dataset = owned(H5Dopen2(file_.id(), name.c_str(), H5P_DEFAULT), H5Dclose, "read " + name);
  const Handle type = owned(H5Dget_type(dataset.id()), H5Tclose, "read " + name);
  const Handle space = owned(H5Dget_space(dataset.id()), H5Sclose, "read " + name);
  demand_one(type, space, H5T_STRING, name);
  std::string text(H5Tget_size(type.id()), '\0');
  require(H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), "read " + name);
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

void File::put_attribute(const std::string& object, const std::string& name, hid_t type, const void* value) {
  const Silence silence;
  const std::string what = "write the attribute " + name + " of " + object;
  const Handle target = owned(H5Oopen(file_.id(), object.c_str(), H5P_DEFAULT), H5Oclose, what);
  const Handle space = owned(H5Screate(H5S_SCALAR), H5Sclose, what);
  const Handle attribute =
      owned(H5Acreate2(target.id(), name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what);
  require(H5Awrite(attribute.id(), type, value), what);
}

void File::set_attribute(const std::string& object, const std::string& name, const std::string& value) {
  const Handle type = text_type(value.size());
  put_attribute(object, name, type.id(), value.c_str());
}

void File::set_attribute(const std::string& object, const std::string& name, double value) {
  put_attribute(object, name, H5T_NATIVE_DOUBLE, &value);
}

void File::set_attribute(const std::string& object, const std::string& name, std::int64_t value) {
  put_attribute(object, name, H5T_NATIVE_INT64, &value);
}

double File::double_attribute(const std::string& object, const std::string& name) const {
  const Silence silence;
  const std::string what = "read the attribute " + name + " of " + object;
  const Handle attribute =
      owned(H5Aopen_by_name(file_.id(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what);
  const Handle type = owned(H5Aget_type(attribute.id()), H5Tclose, what);
  const Handle space = owned(H5Aget_space(attribute.id()), H5Sclose, what);
  demand_one(type, space, H5T_FLOAT, "the attribute " + name);
  double value = 0.0;
  require(H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &value), what);
  return value;
}

std::string File::text_attribute(const std::string& object, const std::string& name) const {
  const Silence silence;
  const std::string what = "read the attribute " + name + " of " + object;
  const Handle attribute =
      owned(H5Aopen_by_name(file_.id(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what);
  const Handle type = owned(H5Aget_type(attribute.id()), H5Tclose, what);
  const Handle space = owned(H5Aget_space(attribute.id()), H5Sclose, what);
  demand_one(type, space, H5T_STRING, "the attribute " + name);
  std::string text(H5Tget_size(type.id()), '\0');
  require(H5Aread(attribute.id(), type.id(), text.data()), what);
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

} // namespace grandamp::hdf5
