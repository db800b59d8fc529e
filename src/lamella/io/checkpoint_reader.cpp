#include "lamella/core/error.h"
#include "lamella/io/checkpoint.h"
#include "lamella/io/detail/checkpoint_seal.h"
#include "lamella/io/detail/hdf5.h"

#include <fmt/format.h>

namespace lamella::io {
namespace {

using detail::Hdf5Handle;
using detail::Hdf5Type;
using detail::QuietHdf5;

}  // namespace

struct CheckpointReader::Impl {
    std::string path;
    Hdf5Handle file;

    InputError error(const std::string& message) const { return InputError({path}, message); }

    void open();
    std::string text_attribute(const char* name) const;
    template <class Value>
    void read(std::string_view name, sim::Part part, std::size_t count, std::vector<Value>& values) const;
    template <class Value>
    void check_dataset(const Hdf5Handle& dataset, std::string_view name, std::size_t count) const;
};

void CheckpointReader::Impl::open() {
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
#if H5_VERSION_GE(1, 10, 7)
    H5Pset_file_locking(access.get(), false,
                        true);  // many network file systems have no locks; a sealed file needs none
#endif
    file = Hdf5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
    if (!file) throw error("is not an HDF5 file, although its checksum is right");
}

std::string CheckpointReader::Impl::text_attribute(const char* name) const {
    const Hdf5Handle attribute(H5Aopen(file.get(), name, H5P_DEFAULT), H5Aclose);
    const Hdf5Handle type(attribute ? H5Aget_type(attribute.get()) : -1, H5Tclose);
    const Hdf5Handle space(attribute ? H5Aget_space(attribute.get()) : -1, H5Sclose);
    const bool is_text =
        type && space && H5Tis_variable_str(type.get()) > 0 && H5Sget_simple_extent_type(space.get()) == H5S_SCALAR;
    const Hdf5Handle memory(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(memory.get(), H5T_VARIABLE);
    H5Tset_cset(memory.get(), H5T_CSET_UTF8);
    char* characters = nullptr;
    if (!is_text || H5Aread(attribute.get(), memory.get(), &characters) < 0) {
        throw error(fmt::format("lacks the attribute \"{}\" of a checkpoint", name));
    }
    std::string text = characters == nullptr ? "" : characters;
    H5free_memory(characters);
    return text;
}

/// The entry must be exactly what CheckpointWriter makes of `count` values, with all of them in the file.
template <class Value>
void CheckpointReader::Impl::check_dataset(const Hdf5Handle& dataset, std::string_view name, std::size_t count) const {
    const Hdf5Handle type(H5Dget_type(dataset.get()), H5Tclose);
    if (!type || H5Tequal(type.get(), Hdf5Type<Value>::file()) <= 0) {
        throw error(fmt::format("entry \"{}\" does not hold {}", name, Hdf5Type<Value>::kName));
    }
    const Hdf5Handle space(H5Dget_space(dataset.get()), H5Sclose);
    hsize_t size = 0;
    if (!space || H5Sget_simple_extent_ndims(space.get()) != 1 ||
        H5Sget_simple_extent_dims(space.get(), &size, nullptr) != 1 || size != count) {
        throw error(fmt::format("entry \"{}\" has {} values, {} were expected", name, size, count));
    }
    const Hdf5Handle options(H5Dget_create_plist(dataset.get()), H5Pclose);
    const bool checked = options && H5Pget_layout(options.get()) == H5D_CHUNKED && H5Pget_nfilters(options.get()) == 1;
    unsigned flags = 0;
    std::size_t parameters = 0;
    const bool whole = count == 0 || (checked &&
                                      H5Pget_filter2(options.get(), 0, &flags, &parameters, nullptr, 0, nullptr,
                                                     nullptr) == H5Z_FILTER_FLETCHER32 &&
                                      H5Dget_storage_size(dataset.get()) >= count * sizeof(Value));
    if (!whole) throw error(fmt::format("entry \"{}\" is not stored as a checkpoint stores it", name));
}

template <class Value>
void CheckpointReader::Impl::read(std::string_view name,
                                  sim::Part part,
                                  std::size_t count,
                                  std::vector<Value>& values) const {
    const QuietHdf5 quiet;
    const std::string terminated(name);
    const Hdf5Handle dataset(H5Dopen2(file.get(), terminated.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset) throw error(fmt::format("has no entry \"{}\"", name));
    check_dataset<Value>(dataset, name, static_cast<std::size_t>(part.total));
    values.resize(count);
    if (count == 0) return;
    const auto first = static_cast<hsize_t>(part.first);
    const hsize_t wanted = count;
    const Hdf5Handle in_file(H5Dget_space(dataset.get()), H5Sclose);
    const Hdf5Handle in_memory(H5Screate_simple(1, &wanted, nullptr), H5Sclose);
    const bool selected = in_file && in_memory &&
                          H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, &first, nullptr, &wanted, nullptr) >= 0;
    if (!selected || H5Dread(dataset.get(), Hdf5Type<Value>::memory(), in_memory.get(), in_file.get(), H5P_DEFAULT,
                             values.data()) < 0) {
        throw error(fmt::format("entry \"{}\" cannot be read: damaged, or the disk failed", name));
    }
}

CheckpointReader::CheckpointReader(const std::filesystem::path& path, const std::string& kind)
    : impl_(std::make_unique<Impl>()) {
    impl_->path = path.string();
    detail::verify_checkpoint_seal(path);
    const QuietHdf5 quiet;
    impl_->open();
    if (impl_->text_attribute("format") != detail::kCheckpointFormat)
        throw impl_->error("is not a checkpoint of lamella");
    const std::string found = impl_->text_attribute("kind");
    if (found != kind) {
        throw impl_->error(fmt::format("holds the state of solver \"{}\", not of \"{}\"", found, kind));
    }
}

CheckpointReader::~CheckpointReader() {
    const QuietHdf5 quiet;
    impl_.reset();
}

void CheckpointReader::read(std::string_view name, std::size_t count, std::vector<double>& values) {
    impl_->read(name, {0, static_cast<std::int64_t>(count)}, count, values);
}
void CheckpointReader::read(std::string_view name, std::size_t count, std::vector<std::int64_t>& values) {
    impl_->read(name, {0, static_cast<std::int64_t>(count)}, count, values);
}
void CheckpointReader::read(std::string_view name, std::size_t count, std::vector<std::int32_t>& values) {
    impl_->read(name, {0, static_cast<std::int64_t>(count)}, count, values);
}
void CheckpointReader::read_stretch(std::string_view name,
                                    sim::Part part,
                                    std::size_t count,
                                    std::vector<double>& values) {
    impl_->read(name, part, count, values);
}
void CheckpointReader::read_stretch(std::string_view name,
                                    sim::Part part,
                                    std::size_t count,
                                    std::vector<std::int64_t>& values) {
    impl_->read(name, part, count, values);
}
void CheckpointReader::read_stretch(std::string_view name,
                                    sim::Part part,
                                    std::size_t count,
                                    std::vector<std::int32_t>& values) {
    impl_->read(name, part, count, values);
}

}  // namespace lamella::io
