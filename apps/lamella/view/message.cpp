#include "view/message.h"

#include "lamella/core/error.h"

#include <bit>
#include <limits>

namespace lamella::app::view {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are little endian");

constexpr std::size_t kAlignment = 4;

void append_number(std::string& out, std::uint32_t value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string padded(std::string text) {
    text.resize((text.size() + kAlignment - 1) / kAlignment * kAlignment, ' ');
    return text;
}

}  // namespace

template <class Value>
void Message::append(const char* type, const std::string& set, const std::string& name, const std::string& unit,
                     int components, std::span<const Value> values) {
    LAMELLA_ASSERT(components > 0 && values.size() % static_cast<std::size_t>(components) == 0);
    arrays_.push_back({{"set", set},
                       {"name", name},
                       {"unit", unit},
                       {"type", type},
                       {"components", components},
                       {"count", values.size() / static_cast<std::size_t>(components)},
                       {"offset", data_.size()}});
    data_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    data_.resize((data_.size() + kAlignment - 1) / kAlignment * kAlignment, '\0');
}

void Message::add(const std::string& set, const std::string& name, const std::string& unit, int components,
                  std::span<const float> values) {
    append("f32", set, name, unit, components, values);
}

void Message::add(const std::string& set, const std::string& name, const std::string& unit, int components,
                  std::span<const std::uint32_t> values) {
    append("u32", set, name, unit, components, values);
}

void Message::add(const std::string& set, const std::string& name, const std::string& unit, int components,
                  std::span<const std::int32_t> values) {
    append("i32", set, name, unit, components, values);
}

void Message::add(const std::string& set, const std::string& name, const std::string& unit, int components,
                  std::span<const std::int16_t> values) {
    append("i16", set, name, unit, components, values);
}

std::string Message::finish(nlohmann::ordered_json header) const {
    if (data_.size() > std::numeric_limits<std::uint32_t>::max())
        throw InputError("this frame is too large for the page: more than 4 GiB even after thinning out");
    header["arrays"] = arrays_;
    const std::string text = padded(header.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    std::string bytes = "LMLA";
    append_number(bytes, 1);
    append_number(bytes, static_cast<std::uint32_t>(text.size()));
    append_number(bytes, static_cast<std::uint32_t>(data_.size()));
    return bytes + text + data_;
}

}  // namespace lamella::app::view
