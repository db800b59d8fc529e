#include "lamella/io/detail/hdf5_output.h"

#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>  // where later versions describe drivers
#endif
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <string_view>

namespace lamella::io::detail {

struct Hdf5Output::Target {
    const FileDescriptor& file;
    int error = 0;
    haddr_t size = 0;

    void note(int code) {
        if (error == 0 && code != 0) error = code > 0 ? code : EIO;
    }
};

namespace {

using Target = Hdf5Output::Target;

/// One open file as HDF5 sees it.
struct OpenFile {
    H5FD_t common;  // first: HDF5 hands out pointers to it
    Target* target;
    haddr_t end = 0;  ///< of the addresses that HDF5 has given to its objects

    static OpenFile& of(H5FD_t* file) { return *reinterpret_cast<OpenFile*>(file); }
    static const OpenFile& of(const H5FD_t* file) { return *reinterpret_cast<const OpenFile*>(file); }
};

/// HDF5 first tries to open what it is asked to create, which is not there.
H5FD_t* open_file(const char*, unsigned flags, hid_t access, haddr_t) {
    const void* const info = H5Pget_driver_info(access);
    if ((flags & H5F_ACC_TRUNC) == 0U || info == nullptr) return nullptr;
    auto* const file = new (std::nothrow) OpenFile{};
    if (file == nullptr) return nullptr;
    std::memcpy(&file->target, info, sizeof file->target);
    return &file->common;
}

herr_t close_file(H5FD_t* file) {
    delete &OpenFile::of(file);
    return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
    if (flags != nullptr)
        *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
                 H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
    return 0;
}

haddr_t end_of_addresses(const H5FD_t* file, H5FD_mem_t) { return OpenFile::of(file).end; }

herr_t set_end_of_addresses(H5FD_t* file, H5FD_mem_t, haddr_t end) {
    OpenFile::of(file).end = end;
    return 0;
}

haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t) { return OpenFile::of(file).target->size; }

/// What lies beyond the end, or was lost, reads as zeros.
herr_t read_bytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* out) {
    Target& target = *OpenFile::of(file).target;
    std::memset(out, 0, size);
    if (target.error != 0 || at >= target.size) return 0;
    const auto here = static_cast<std::size_t>(std::min<haddr_t>(size, target.size - at));
    target.note(read_at(target.file, at, static_cast<char*>(out), here));
    return 0;
}

herr_t write_bytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, const void* bytes) {
    Target& target = *OpenFile::of(file).target;
    if (target.error == 0) target.note(write_at(target.file, at, {static_cast<const char*>(bytes), size}));
    target.size = std::max<haddr_t>(target.size, at + size);
    return 0;
}

/// The file ends where HDF5's addresses do.
herr_t truncate_file(H5FD_t* file, hid_t, hbool_t) {
    OpenFile& open = OpenFile::of(file);
    Target& target = *open.target;
    if (target.error == 0 && ::ftruncate(target.file.get(), static_cast<off_t>(open.end)) != 0) target.note(errno);
    target.size = open.end;
    return 0;
}

H5FD_class_t driver_class() {
    H5FD_class_t driver{};
#ifdef H5FD_CLASS_VERSION
    driver.version = H5FD_CLASS_VERSION;
    driver.value = static_cast<H5FD_class_value_t>(H5_VFD_RESERVED + 1);
#endif
    driver.name = "lamella";
    driver.maxaddr = static_cast<haddr_t>(std::numeric_limits<off_t>::max());
    driver.fc_degree = H5F_CLOSE_WEAK;
    driver.fapl_size = sizeof(Target*);
    driver.open = open_file;
    driver.close = close_file;
    driver.query = query;
    driver.get_eoa = end_of_addresses;
    driver.set_eoa = set_end_of_addresses;
    driver.get_eof = end_of_file;
    driver.read = read_bytes;
    driver.write = write_bytes;
    driver.truncate = truncate_file;
    std::fill(std::begin(driver.fl_map), std::end(driver.fl_map), H5FD_MEM_DEFAULT);
    return driver;
}

}  // namespace

Hdf5Output::Hdf5Output(const FileDescriptor& file) : target_(std::make_unique<Target>(Target{file})) {
    const H5FD_class_t driver = driver_class();
    driver_ = Hdf5Handle(H5FDregister(&driver), H5FDunregister);
}

Hdf5Output::~Hdf5Output() = default;

bool Hdf5Output::set_driver(const Hdf5Handle& access) const {
    const Target* const target = target_.get();
    return driver_ && H5Pset_driver(access.get(), driver_.get(), &target) >= 0;
}

int Hdf5Output::error() const { return target_->error; }

std::size_t Hdf5Output::size() const { return static_cast<std::size_t>(target_->size); }

}  // namespace lamella::io::detail
