#pragma once

#include "lamella/io/detail/hdf5.h"
#include "lamella/io/detail/output_file.h"

#include <cstddef>
#include <memory>

namespace lamella::io::detail {

/// What HDF5 writes goes through this into a file of ours, as a file driver of HDF5's.
///
/// HDF5 hides why a write failed and is left in a state that may crash when it ends. So it never hears of a
/// failure: the first one is kept for error(), after which nothing more is written.
class Hdf5Output {
public:
    /// @param file  empty so far; it must outlive this
    explicit Hdf5Output(const FileDescriptor& file);
    ~Hdf5Output();
    Hdf5Output(const Hdf5Output&) = delete;
    Hdf5Output& operator=(const Hdf5Output&) = delete;

    /// Makes H5Fcreate with these options create that file, whatever name it is given. Close it before this ends.
    bool set_driver(const Hdf5Handle& access) const;

    /// The error number of the first read or write that failed, or 0.
    int error() const;
    /// Bytes of the file.
    std::size_t size() const;

    struct Target;  ///< what the driver sees

private:
    std::unique_ptr<Target> target_;
    Hdf5Handle driver_;
};

}  // namespace lamella::io::detail
