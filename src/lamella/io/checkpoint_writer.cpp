#include "lamella/core/error.h"
#include "lamella/io/checkpoint.h"
#include "lamella/io/detail/checkpoint_seal.h"
#include "lamella/io/detail/hdf5.h"
#include "lamella/io/detail/output_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace lamella::io {
namespace {

using detail::Hdf5Handle;
using detail::Hdf5Type;
using detail::QuietHdf5;

constexpr std::size_t kImageIncrement = 4096;  ///< bytes; the file is a multiple. Growing costs no copy (mremap)
constexpr hsize_t kChunk = hsize_t{1} << 17;   ///< values; 1 MiB of doubles, what HDF5's cache holds of a dataset

/// The file while HDF5 builds it. HDF5's "core" driver asks these functions for memory; the one thing they do
/// differently from malloc is to keep the buffer when HDF5 closes the file, which saves a copy of it.
struct Image {
    char* bytes = nullptr;
    std::size_t size = 0;

    Image() = default;
    Image(const Image&) = delete;
    Image& operator=(const Image&) = delete;
    ~Image() { std::free(bytes); }

    /// There is one buffer at any time, so HDF5's own pointer to it need not be looked at.
    void* grow(std::size_t wanted) {
        void* const grown = std::realloc(bytes, wanted);
        if (grown == nullptr) return nullptr;
        bytes = static_cast<char*>(grown);
        size = wanted;
        return grown;
    }

    static void* allocate(std::size_t size, H5FD_file_image_op_t, void* image) {
        return static_cast<Image*>(image)->grow(size);
    }
    static void* copy(void* to, const void* from, std::size_t size, H5FD_file_image_op_t, void*) {
        return std::memcpy(to, from, size);
    }
    static void* resize(void*, std::size_t size, H5FD_file_image_op_t, void* image) {
        return static_cast<Image*>(image)->grow(size);
    }
    static herr_t release(void*, H5FD_file_image_op_t, void*) { return 0; }  // the buffer stays ours
    static void* share(void* image) { return image; }
    static herr_t unshare(void*) { return 0; }

    H5FD_file_image_callbacks_t callbacks() { return {allocate, copy, resize, release, share, unshare, this}; }
};

/// "foam/position": words separated by single slashes, none of them "." or "..".
bool is_valid_name(std::string_view name) {
    while (true) {
        const std::size_t slash = std::min(name.find('/'), name.size());
        const std::string_view word = name.substr(0, slash);
        if (word.empty() || word == "." || word == ".." || word.find('\0') != std::string_view::npos) return false;
        if (slash == name.size()) return true;
        name.remove_prefix(slash + 1);
    }
}

}  // namespace

struct CheckpointWriter::Impl {
    std::filesystem::path path;
    Image image;
    detail::AtomicFile output;
    Hdf5Handle link_options;
    Hdf5Handle file;  // after the image: closed before the image is freed

    explicit Impl(std::filesystem::path p) : path(std::move(p)), output(path) {}

    /// What HDF5 can still refuse when no disk is involved is memory.
    void check(bool success) const {
        if (!success) {
            throw IoError(
                fmt::format("cannot write {}: HDF5 failed while it built the file; out of memory?", path.string()));
        }
    }
    void check(const Hdf5Handle& handle) const { check(static_cast<bool>(handle)); }

    void create_image();
    void write_attribute(const char* name, const std::string& text);
    void write_attribute(const char* name, std::int64_t value);
    Hdf5Handle dataset_options(hsize_t count) const;
    template <class Value>
    void write(std::string_view name, std::span<const Value> values);
};

void CheckpointWriter::Impl::create_image() {
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    check(H5Pset_fapl_core(access.get(), kImageIncrement, false) >= 0);
    H5FD_file_image_callbacks_t callbacks = image.callbacks();
    check(H5Pset_file_image_callbacks(access.get(), &callbacks) >= 0);
    const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    check(H5Pset_userblock(creation.get(), detail::kSealSize) >= 0);
    // HDF5 would first read a file that has this name. No file can be below a file.
    const std::filesystem::path name = path / "image";
    file = Hdf5Handle(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose);
    check(file);
    link_options = Hdf5Handle(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    check(H5Pset_create_intermediate_group(link_options.get(), 1) >= 0);
}

void CheckpointWriter::Impl::write_attribute(const char* name, const std::string& text) {
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    check(H5Tset_size(type.get(), H5T_VARIABLE) >= 0 && H5Tset_cset(type.get(), H5T_CSET_UTF8) >= 0);
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle attribute(H5Acreate2(file.get(), name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose);
    const char* const characters = text.c_str();
    check(attribute && H5Awrite(attribute.get(), type.get(), &characters) >= 0);
}

void CheckpointWriter::Impl::write_attribute(const char* name, std::int64_t value) {
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle attribute(H5Acreate2(file.get(), name, H5T_STD_I64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose);
    check(attribute && H5Awrite(attribute.get(), H5T_NATIVE_INT64, &value) >= 0);
}

/// Chunks with a checksum; without time stamps, so that the same state gives the same bytes.
Hdf5Handle CheckpointWriter::Impl::dataset_options(hsize_t count) const {
    Hdf5Handle options(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    check(options && H5Pset_obj_track_times(options.get(), false) >= 0);
    if (count == 0) return options;  // HDF5 has no empty chunks, and there is nothing to check
    const hsize_t chunk = std::min(count, kChunk);
    check(H5Pset_chunk(options.get(), 1, &chunk) >= 0 && H5Pset_fletcher32(options.get()) >= 0);
    return options;
}

template <class Value>
void CheckpointWriter::Impl::write(std::string_view name, std::span<const Value> values) {
    if (!is_valid_name(name)) throw InputError(fmt::format("\"{}\" cannot be the name of a state entry", name));
    const QuietHdf5 quiet;
    const std::string terminated(name);
    const hsize_t count = values.size();
    const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
    check(space);
    const Hdf5Handle options = dataset_options(count);
    const Hdf5Handle dataset(H5Dcreate2(file.get(), terminated.c_str(), Hdf5Type<Value>::file(), space.get(),
                                        link_options.get(), options.get(), H5P_DEFAULT),
                             H5Dclose);
    if (!dataset && H5Lexists(file.get(), terminated.c_str(), H5P_DEFAULT) > 0) {
        throw InputError(fmt::format("the state entry \"{}\" is written twice", name));
    }
    check(dataset);
    if (count == 0) return;
    check(H5Dwrite(dataset.get(), Hdf5Type<Value>::memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
}

CheckpointWriter::CheckpointWriter(std::filesystem::path path, const std::string& kind)
    : impl_(std::make_unique<Impl>(std::move(path))) {
    const QuietHdf5 quiet;
    impl_->create_image();
    impl_->write_attribute("format", detail::kCheckpointFormat);
    impl_->write_attribute("version", detail::kCheckpointVersion);
    impl_->write_attribute("kind", kind);
}

CheckpointWriter::~CheckpointWriter() {
    const QuietHdf5 quiet;
    impl_.reset();
}

void CheckpointWriter::write(std::string_view name, std::span<const double> values) { impl_->write(name, values); }
void CheckpointWriter::write(std::string_view name, std::span<const std::int64_t> values) {
    impl_->write(name, values);
}
void CheckpointWriter::write(std::string_view name, std::span<const std::int32_t> values) {
    impl_->write(name, values);
}

void CheckpointWriter::commit() {
    const QuietHdf5 quiet;
    impl_->check(impl_->file.reset());
    const std::string_view image(impl_->image.bytes, impl_->image.size);
    const std::string_view hdf5_part = image.substr(detail::kSealSize);
    impl_->output.write(detail::checkpoint_seal(hdf5_part));
    impl_->output.write(hdf5_part);
    impl_->output.commit(detail::OldFile::kKeepAsPrevious);
}

}  // namespace lamella::io
