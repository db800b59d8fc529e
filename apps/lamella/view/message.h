#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <span>
#include <string>

namespace lamella::app::view {

/// One answer of the server that carries arrays: what the page can put on the graphics card as it is.
///
///   bytes 0..3   "LMLA"
///   4..7         format, 1
///   8..11        bytes of the header
///   12..15       bytes of the data
///   header       JSON; `arrays` lists {set, name, unit, type, components, count, offset}, offsets from the data's start
///   data         the arrays, little endian, each at a multiple of 4 bytes
///
/// `type` is f32, u32, i32 or i16. docs/view.md has the table of sets; web/src/decode.ts reads it.
class Message {
public:
    /// Appends an array of `components` values an item. `set` says what the items are: "vertices", "points", ...
    void add(const std::string& set, const std::string& name, const std::string& unit, int components,
             std::span<const float> values);
    void add(const std::string& set, const std::string& name, const std::string& unit, int components,
             std::span<const std::uint32_t> values);
    void add(const std::string& set, const std::string& name, const std::string& unit, int components,
             std::span<const std::int32_t> values);
    void add(const std::string& set, const std::string& name, const std::string& unit, int components,
             std::span<const std::int16_t> values);

    /// The bytes, with `header` and the list of arrays in front.
    std::string finish(nlohmann::ordered_json header) const;

private:
    template <class Value>
    void append(const char* type, const std::string& set, const std::string& name, const std::string& unit,
                int components, std::span<const Value> values);

    nlohmann::ordered_json arrays_ = nlohmann::ordered_json::array();
    std::string data_;
};

}  // namespace lamella::app::view
