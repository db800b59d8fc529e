#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::sim {

/// Where a stretch of a column lies in the whole: what one of several processes holds, or what comes next.
struct Part {
    std::int64_t first = 0;
    std::int64_t total = 0;
};

/// Where a solver saves its complete state. Names are unique within one state; groups are written "foam/position".
class StateWriter {
public:
    virtual ~StateWriter() = default;
    virtual void write(std::string_view name, std::span<const double> values) = 0;
    virtual void write(std::string_view name, std::span<const std::int64_t> values) = 0;
    virtual void write(std::string_view name, std::span<const std::int32_t> values) = 0;

    /// Writes a column in parts. To a solver's share of several processes this is collective: each holds a part, ranks
    /// in order, and one process holds all of it. A file gets the parts one after another.
    virtual void write_part(std::string_view name, std::span<const double> values, Part) { write(name, values); }
    virtual void write_part(std::string_view name, std::span<const std::int64_t> values, Part) { write(name, values); }
    virtual void write_part(std::string_view name, std::span<const std::int32_t> values, Part) { write(name, values); }

    void write_value(std::string_view name, double value) { write(name, std::span<const double>(&value, 1)); }
    void write_value(std::string_view name, std::int64_t value) {
        write(name, std::span<const std::int64_t>(&value, 1));
    }
};

/// Where a solver finds it again. Every read says how many values it expects, so that a damaged or hostile file is
/// refused before memory is taken.
class StateReader {
public:
    virtual ~StateReader() = default;
    /// @throws InputError  the entry is missing, has another type, or another number of values
    virtual void read(std::string_view name, std::size_t count, std::vector<double>& values) = 0;
    virtual void read(std::string_view name, std::size_t count, std::vector<std::int64_t>& values) = 0;
    virtual void read(std::string_view name, std::size_t count, std::vector<std::int32_t>& values) = 0;

    /// Reads this process's share of a column of `total` values (dist::share_of); collective. One process gets all.
    virtual void read_part(std::string_view name, std::size_t total, std::vector<double>& v) { read(name, total, v); }
    virtual void read_part(std::string_view name, std::size_t total, std::vector<std::int64_t>& v) {
        read(name, total, v);
    }
    virtual void read_part(std::string_view name, std::size_t total, std::vector<std::int32_t>& v) {
        read(name, total, v);
    }

    /// Reads `count` values from `part.first` on of a column of `part.total`.
    virtual void read_stretch(std::string_view name, Part part, std::size_t count, std::vector<double>& values) {
        cut(name, part, count, values);
    }
    virtual void read_stretch(std::string_view name, Part part, std::size_t count, std::vector<std::int64_t>& values) {
        cut(name, part, count, values);
    }
    virtual void read_stretch(std::string_view name, Part part, std::size_t count, std::vector<std::int32_t>& values) {
        cut(name, part, count, values);
    }

    double read_double(std::string_view name) {
        std::vector<double> value;
        read(name, 1, value);
        return value[0];
    }
    std::int64_t read_integer(std::string_view name) {
        std::vector<std::int64_t> value;
        read(name, 1, value);
        return value[0];
    }

private:
    template <class T>
    void cut(std::string_view name, Part part, std::size_t count, std::vector<T>& values) {
        std::vector<T> all;
        read(name, static_cast<std::size_t>(part.total), all);
        const auto first = all.begin() + static_cast<std::ptrdiff_t>(part.first);
        values.assign(first, first + static_cast<std::ptrdiff_t>(count));
    }
};

}  // namespace lamella::sim
