// Hostile checkpoints: the input as a file, and as a list of changes to a valid one. The seal must keep all of them
// from HDF5, which is not made for hostile files; what a forged seal could do is outside this test (checkpoint.h).

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/checkpoint.h"

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

/// In memory where the system has a file system there; removed when the fuzzer ends.
struct ScratchFile {
    std::filesystem::path path = std::filesystem::path(std::filesystem::exists("/dev/shm") ? "/dev/shm" : "/tmp") /
                                 ("lamella-checkpoint-fuzz." + std::to_string(getpid()));
    ~ScratchFile() { std::filesystem::remove(path); }

    void put(std::string_view bytes) const {
        std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
};

std::string valid_checkpoint(const ScratchFile& file) {
    lamella::io::CheckpointWriter out(file.path, "bubble");
    out.write("foam/position", std::vector<double>{1.0, 2.0, 3.0});
    out.write_value("step", std::int64_t{42});
    out.commit();
    return lamella::io::read_file(file.path);
}

/// Three bytes of input are one change: two say where, the third is put there.
std::string changed(std::string bytes, std::string_view changes) {
    for (; changes.size() >= 3; changes.remove_prefix(3)) {
        const auto byte = [&](std::size_t k) { return std::size_t{static_cast<std::uint8_t>(changes[k])}; };
        bytes[(byte(0) << 8 | byte(1)) % bytes.size()] = changes[2];
    }
    return bytes;
}

/// Reads a file that differs from `valid`. Either it is refused, or the changes cancelled out.
void read(const ScratchFile& file, const std::string& bytes, const std::string& valid) {
    file.put(bytes);
    try {
        lamella::io::CheckpointReader in(file.path, "bubble");
        std::vector<double> values;
        in.read("foam/position", 3, values);
        if (bytes != valid) std::abort();
    } catch (const lamella::InputError&) {  // the only polite answer; anything else ends the fuzzer
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const ScratchFile file;
    static const std::string valid = valid_checkpoint(file);
    const std::string_view input(reinterpret_cast<const char*>(data), size);
    read(file, std::string(input), valid);
    read(file, changed(valid, input), valid);
    return 0;
}
