#pragma once

#include "lamella/core/error.h"
#include "lamella/sim/archive.h"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::test {

/// A checkpoint in memory, for tests of solvers.
struct StateMemory : sim::StateWriter, sim::StateReader {
    std::map<std::string, std::vector<double>, std::less<>> reals;
    std::map<std::string, std::vector<std::int64_t>, std::less<>> integers;

    void write(std::string_view name, std::span<const double> v) override {
        reals[std::string(name)].assign(v.begin(), v.end());
    }
    void write(std::string_view name, std::span<const std::int64_t> v) override {
        integers[std::string(name)].assign(v.begin(), v.end());
    }
    void write(std::string_view name, std::span<const std::int32_t> v) override {
        integers[std::string(name)].assign(v.begin(), v.end());
    }
    template <class From, class To>
    static void fetch(const From& from, std::string_view name, std::size_t count, To& values) {
        const auto it = from.find(name);
        if (it == from.end() || it->second.size() != count) throw InputError(std::string(name));
        values.assign(it->second.begin(), it->second.end());
    }
    void read(std::string_view name, std::size_t count, std::vector<double>& v) override { fetch(reals, name, count, v); }
    void read(std::string_view name, std::size_t count, std::vector<std::int64_t>& v) override {
        fetch(integers, name, count, v);
    }
    void read(std::string_view name, std::size_t count, std::vector<std::int32_t>& v) override {
        std::vector<std::int64_t> wide;
        fetch(integers, name, count, wide);
        v.assign(wide.begin(), wide.end());
    }
};

}  // namespace lamella::test
