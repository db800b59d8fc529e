#include "lamella/core/error.h"
#include "lamella/io/checkpoint.h"
#include "lamella/io/detail/checkpoint_seal.h"
#include "lamella/io/detail/hdf5.h"
#include "lamella/io/detail/hdf5_output.h"
#include "lamella/io/detail/output_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

namespace lamella::io {
namespace {

using detail::Hdf5Handle;
using detail::Hdf5Type;
using detail::QuietHdf5;

constexpr hsize_t kChunk = hsize_t{1} << 17;  ///< values; 1 MiB of doubles, what HDF5's cache holds of a dataset

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

/// A column on its way into the file. HDF5 gets it chunk by chunk, however it comes, so that the file has the same
/// bytes.
struct Column {
    std::string name;
    Hdf5Handle dataset;
    hsize_t total = 0;
    hsize_t written = 0;             ///< values in the file
    std::vector<std::byte> waiting;  ///< what came of the next chunk

    hsize_t received(std::size_t value_size) const { return written + waiting.size() / value_size; }
};

struct CheckpointWriter::Impl {
    std::filesystem::path path;
    detail::AtomicFile file_on_disk;
    detail::Hdf5Output output;
    Hdf5Handle link_options;
    Hdf5Handle file;  // after the output: closed before that ends
    std::optional<Column> column;

    explicit Impl(std::filesystem::path p)
        : path(std::move(p)), file_on_disk(path), output(file_on_disk.descriptor()) {}

    /// What HDF5 itself can refuse is memory.
    void check(bool success) const {
        if (output.error() != 0) detail::throw_io_error("write", path, output.error());
        if (!success) throw IoError(fmt::format("cannot write {}: HDF5 failed; out of memory?", path.string()));
    }
    void check(const Hdf5Handle& handle) const { check(static_cast<bool>(handle)); }

    void create_file();
    void write_attribute(const char* name, const std::string& text);
    void write_attribute(const char* name, std::int64_t value);
    Hdf5Handle dataset_options(hsize_t count) const;
    template <class Value>
    Column open_column(std::string_view name, hsize_t total) const;
    template <class Value>
    void put(Column& to, std::span<const Value> values) const;
    template <class Value>
    void append(Column& to, std::span<const Value> values) const;
    template <class Value>
    void write(std::string_view name, std::span<const Value> values, sim::Part part);
};

void CheckpointWriter::Impl::create_file() {
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    check(output.set_driver(access));
    const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    check(H5Pset_userblock(creation.get(), detail::kSealSize) >= 0);
    file = Hdf5Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose);
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
Column CheckpointWriter::Impl::open_column(std::string_view name, hsize_t total) const {
    if (!is_valid_name(name)) throw InputError(fmt::format("\"{}\" cannot be the name of a state entry", name));
    Column opened{.name = std::string(name), .dataset = {}, .total = total, .waiting = {}};
    const Hdf5Handle space(H5Screate_simple(1, &total, nullptr), H5Sclose);
    check(space);
    const Hdf5Handle options = dataset_options(total);
    opened.dataset = Hdf5Handle(H5Dcreate2(file.get(), opened.name.c_str(), Hdf5Type<Value>::file(), space.get(),
                                           link_options.get(), options.get(), H5P_DEFAULT),
                                H5Dclose);
    if (!opened.dataset && H5Lexists(file.get(), opened.name.c_str(), H5P_DEFAULT) > 0)
        throw InputError(fmt::format("the state entry \"{}\" is written twice", name));
    check(opened.dataset);
    return opened;
}

/// The next values of a column: a chunk, or the last of them.
template <class Value>
void CheckpointWriter::Impl::put(Column& to, std::span<const Value> values) const {
    const hsize_t count = values.size();
    const Hdf5Handle in_file(H5Dget_space(to.dataset.get()), H5Sclose);
    const Hdf5Handle in_memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
    check(in_file && in_memory &&
          H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, &to.written, nullptr, &count, nullptr) >= 0 &&
          H5Dwrite(to.dataset.get(), Hdf5Type<Value>::memory(), in_memory.get(), in_file.get(), H5P_DEFAULT,
                   values.data()) >= 0);
    to.written += count;
}

template <class Value>
void CheckpointWriter::Impl::append(Column& to, std::span<const Value> values) const {
    while (!values.empty()) {
        const auto next = static_cast<std::size_t>(std::min(kChunk, to.total - to.written));
        if (to.waiting.empty() && values.size() >= next) {
            put(to, values.first(next));
            values = values.subspan(next);
            continue;
        }
        const std::size_t taken = std::min(values.size(), next - to.waiting.size() / sizeof(Value));
        const auto bytes = std::as_bytes(values.first(taken));
        to.waiting.insert(to.waiting.end(), bytes.begin(), bytes.end());
        values = values.subspan(taken);
        if (to.waiting.size() < next * sizeof(Value)) continue;
        std::vector<Value> chunk(next);
        std::memcpy(chunk.data(), to.waiting.data(), to.waiting.size());
        put(to, std::span<const Value>(chunk));
        to.waiting.clear();
    }
}

template <class Value>
void CheckpointWriter::Impl::write(std::string_view name, std::span<const Value> values, sim::Part part) {
    const QuietHdf5 quiet;
    if (part.first == 0 && !column) column = open_column<Value>(name, static_cast<hsize_t>(part.total));
    LAMELLA_ASSERT(column && column->name == name && static_cast<hsize_t>(part.total) == column->total &&
                   static_cast<hsize_t>(part.first) == column->received(sizeof(Value)) &&
                   values.size() <= column->total - column->received(sizeof(Value)));
    append(*column, values);
    if (column->written < column->total) return;
    check(column->dataset.reset());
    column.reset();
}

CheckpointWriter::CheckpointWriter(std::filesystem::path path, const std::string& kind)
    : impl_(std::make_unique<Impl>(std::move(path))) {
    const QuietHdf5 quiet;
    impl_->create_file();
    impl_->write_attribute("format", detail::kCheckpointFormat);
    impl_->write_attribute("version", detail::kCheckpointVersion);
    impl_->write_attribute("kind", kind);
}

CheckpointWriter::~CheckpointWriter() {
    const QuietHdf5 quiet;
    impl_.reset();
}

namespace {

sim::Part all_of(std::size_t count) { return {0, static_cast<std::int64_t>(count)}; }

}  // namespace

void CheckpointWriter::write(std::string_view name, std::span<const double> values) {
    impl_->write(name, values, all_of(values.size()));
}
void CheckpointWriter::write(std::string_view name, std::span<const std::int64_t> values) {
    impl_->write(name, values, all_of(values.size()));
}
void CheckpointWriter::write(std::string_view name, std::span<const std::int32_t> values) {
    impl_->write(name, values, all_of(values.size()));
}
void CheckpointWriter::write_part(std::string_view name, std::span<const double> values, sim::Part part) {
    impl_->write(name, values, part);
}
void CheckpointWriter::write_part(std::string_view name, std::span<const std::int64_t> values, sim::Part part) {
    impl_->write(name, values, part);
}
void CheckpointWriter::write_part(std::string_view name, std::span<const std::int32_t> values, sim::Part part) {
    impl_->write(name, values, part);
}

void CheckpointWriter::commit() {
    const QuietHdf5 quiet;
    LAMELLA_ASSERT(!impl_->column);
    impl_->check(impl_->file.reset());
    const detail::FileDescriptor& disk = impl_->file_on_disk.descriptor();
    const std::string seal = detail::checkpoint_seal(disk, impl_->output.size(), impl_->path);
    impl_->file_on_disk.write_at(0, seal);
    impl_->file_on_disk.commit(detail::OldFile::kKeepAsPrevious);
}

}  // namespace lamella::io
