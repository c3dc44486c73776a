#include "io/hdf5_file.h"

namespace wisp::hdf5 {

namespace {

void check(herr_t status, const std::string& what) {
  if (status < 0) throw Failure(what);
}

/// No error stack on the terminal (errors are exceptions here), and no file locks, which some network file
/// systems lack: our files are private until they are renamed.
Id access_list() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "no access list");
  check(H5Pset_file_locking(access, false, true), "cannot turn file locks off");
  check(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V110), "cannot set the library's bounds");
  return access;
}

Id text_type(std::size_t length) {
  Id type(H5Tcopy(H5T_C_S1), H5Tclose, "no text type");
  check(H5Tset_size(type, length), "cannot size a text");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "cannot set UTF-8");
  check(H5Tset_strpad(type, H5T_STR_NULLPAD), "cannot set padding");
  return type;
}

void write_attribute(hid_t object, const char* name, hid_t type, const void* value) {
  const Id space(H5Screate(H5S_SCALAR), H5Sclose, "no scalar space");
  const Id attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
  check(H5Awrite(attribute, type, value), name);
}

Id open_attribute(hid_t object, const char* name) {
  return Id(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, name);
}

/// Each kind of array says which it is; a type that merely converts is not accepted.
void write_dataset(hid_t file, const std::string& name, hid_t type, hid_t space, const void* values) {
  const Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "no creation list");
  check(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED), "cannot keep the order of attributes");
  const Id dataset(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose,
                   name.c_str());
  if (values) check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name);
}

}  // namespace

Id create_file(const std::filesystem::path& path, hsize_t user_block) {
  const Id access = access_list();
  const Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "no creation list");
  check(H5Pset_userblock(creation, user_block), "cannot set the user block");
  check(H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED),
        "cannot keep the order of names");
  return Id(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose, "cannot create the file");
}

Id open_file(const std::filesystem::path& path) {
  const Id access = access_list();
  return Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose, "not an HDF5 file");
}

void write_array(hid_t file, const std::string& name, hid_t type, const void* values, std::size_t count) {
  const hsize_t extent = count;
  const Id space(H5Screate_simple(1, &extent, nullptr), H5Sclose, "no space");
  write_dataset(file, name, type, space, count > 0 ? values : nullptr);
}

std::size_t array_size(hid_t dataset) {
  const Id space(H5Dget_space(dataset), H5Sclose, "no space");
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  if (count < 0) throw Failure("no extent");
  return static_cast<std::size_t>(count);
}

// Fixed-length text with one byte more than it needs: HDF5 has no texts of length 0, and a text may end in
// zeros.
void write_text(hid_t file, const std::string& name, const std::string& text) {
  const Id type = text_type(text.size() + 1);
  const Id space(H5Screate(H5S_SCALAR), H5Sclose, "no scalar space");
  write_dataset(file, name, type, space, text.c_str());
}

std::string read_text(hid_t dataset) {
  const Id type(H5Dget_type(dataset), H5Tclose, "no type");
  std::string text(H5Tget_size(type), '\0');
  check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), "cannot read a text");
  text.pop_back();
  return text;
}

void write_attribute(hid_t object, const char* name, std::int64_t value) {
  write_attribute(object, name, H5T_NATIVE_INT64, &value);
}

void write_attribute(hid_t object, const char* name, double value) {
  write_attribute(object, name, H5T_NATIVE_DOUBLE, &value);
}

void write_attribute(hid_t object, const char* name, const std::string& text) {
  const Id type = text_type(text.size() + 1);
  write_attribute(object, name, type, text.c_str());
}

std::int64_t read_integer(hid_t object, const char* name) {
  const Id attribute = open_attribute(object, name);
  std::int64_t value = 0;
  check(H5Aread(attribute, H5T_NATIVE_INT64, &value), name);
  return value;
}

double read_double(hid_t object, const char* name) {
  const Id attribute = open_attribute(object, name);
  double value = 0.0;
  check(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), name);
  return value;
}

std::string read_attribute_text(hid_t object, const char* name) {
  const Id attribute = open_attribute(object, name);
  const Id type(H5Aget_type(attribute), H5Tclose, "no type");
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) throw Failure(name);
  std::string text(H5Tget_size(type), '\0');
  check(H5Aread(attribute, type, text.data()), name);
  text.pop_back();
  return text;
}

}  // namespace wisp::hdf5
