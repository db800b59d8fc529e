// PLY as text and as little-endian bytes: the header names elements and their properties, then come the items.

#include "lamella/core/error.h"
#include "lamella/io/detail/evolver_datafile.h"
#include "lamella/io/detail/film_labels.h"
#include "lamella/io/mesh_files.h"
#include "lamella/mesh/label_sides.h"
#include "lamella/sim/node.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

namespace lamella::io {
namespace {

using mesh::RegionId;
using mesh::VertexId;

static_assert(std::endian::native == std::endian::little, "binary PLY is read as it lies in memory");

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct TypeName {
    std::string_view name;
    Type type;
};
constexpr TypeName kTypes[] = {
    {"char", Type::kInt8},     {"int8", Type::kInt8},     {"uchar", Type::kUint8},   {"uint8", Type::kUint8},
    {"short", Type::kInt16},   {"int16", Type::kInt16},   {"ushort", Type::kUint16}, {"uint16", Type::kUint16},
    {"int", Type::kInt32},     {"int32", Type::kInt32},   {"uint", Type::kUint32},   {"uint32", Type::kUint32},
    {"float", Type::kFloat},   {"float32", Type::kFloat}, {"double", Type::kDouble}, {"float64", Type::kDouble}};

std::size_t size_of(Type type) {
    constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

struct Property {
    std::string name;
    Type type = Type::kDouble;
    std::optional<Type> count;  ///< of a list: the type of its length
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;

    /// Bytes that an item takes at least, as text or in binary.
    std::uint64_t least_size(bool binary) const {
        std::uint64_t size = 0;
        for (const Property& p : properties) size += !binary ? 2 : size_of(p.count.value_or(p.type));
        return std::max<std::uint64_t>(size, 1);
    }
};

std::string shown(std::string_view word) { return sim::quoted_text(word.substr(0, 40)); }

class PlyParser {
public:
    PlyParser(std::string_view contents, const std::string& name) : rest_(contents), name_(name) {}

    FilmFile parse() {
        header();
        for (const Element& element : elements_) {
            // The last item of a text may lack its line end.
            if (element.count > (rest_.size() + 1) / element.least_size(binary_))
                refuse(fmt::format("{} items of element {} do not fit into the {} bytes that are left", element.count,
                                   shown(element.name), rest_.size()));
            if (element.name == "vertex") vertices(element);
            else if (element.name == "face") faces(element);
            else skip(element);
        }
        const mesh::ElementNames names{{}, [this](mesh::FaceId f) { return std::to_string(origin_[index(f)]); }};
        if (given_) mesh_.regions.resize(largest_ + 1, {mesh::RegionKind::kOpen, 0.0});
        detail::complete_films(mesh_, given_ ? detail::Labels::kGiven : detail::Labels::kMissing, name_, names);
        FilmFile films;
        films.mesh = std::move(mesh_);
        return films;
    }

private:
    [[noreturn]] void refuse(const std::string& what) const { throw InputError({name_, 0, 0}, what); }

    // The header.

    std::vector<std::string_view> header_line() {
        constexpr std::size_t kLongest = 4096;
        const std::size_t end = rest_.substr(0, kLongest).find('\n');
        if (end == std::string_view::npos) refuse("the header has no end_header");
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        std::vector<std::string_view> words;
        while (!line.empty()) {
            const std::size_t begin = line.find_first_not_of(" \t\r");
            if (begin == std::string_view::npos) break;
            const std::size_t stop = std::min(line.find_first_of(" \t\r", begin), line.size());
            words.push_back(line.substr(begin, stop - begin));
            line.remove_prefix(stop);
        }
        return words;
    }

    void header() {
        const auto magic = header_line();
        if (magic.size() != 1 || magic[0] != "ply") refuse("does not begin with the line \"ply\"");
        bool format = false;
        for (auto words = header_line(); words.size() != 1 || words[0] != "end_header"; words = header_line()) {
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
            if (words[0] == "format" && words.size() == 3) {
                if (words[1] != "ascii" && words[1] != "binary_little_endian")
                    refuse(fmt::format("format {} is not supported; ascii and binary_little_endian are", shown(words[1])));
                binary_ = words[1] != "ascii";
                format = true;
            } else if (words[0] == "element" && words.size() == 3) {
                add_element(words);
            } else if (words[0] == "property") {
                add_property(words);
            } else {
                refuse(fmt::format("the header has a line {} that PLY does not know", shown(words[0])));
            }
        }
        if (!format) refuse("the header has no format");
        for (const char* needed : {"vertex", "face"})
            if (std::none_of(elements_.begin(), elements_.end(), [&](const Element& e) { return e.name == needed; }))
                refuse(fmt::format("the header has no element {}", needed));
    }

    void add_element(const std::vector<std::string_view>& words) {
        Element element{std::string(words[1]), 0, {}};
        const auto [end, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
        if (error != std::errc{} || end != words[2].data() + words[2].size())
            refuse(fmt::format("element {}: {} is no count", shown(words[1]), shown(words[2])));
        for (const Element& other : elements_)
            if (other.name == element.name) refuse(fmt::format("element {} is there twice", shown(words[1])));
        elements_.push_back(std::move(element));
    }

    Type type_from(std::string_view word) const {
        for (const TypeName& known : kTypes)
            if (known.name == word) return known.type;
        refuse(fmt::format("{} is no type of PLY", shown(word)));
    }

    void add_property(const std::vector<std::string_view>& words) {
        const bool list = words.size() == 5 && words[1] == "list";
        if (elements_.empty() || (!list && words.size() != 3)) refuse("the header has a property in a wrong place");
        std::vector<Property>& properties = elements_.back().properties;
        Property property{std::string(words.back()), type_from(words[list ? 3 : 1]), {}};
        if (list) property.count = type_from(words[2]);
        for (const Property& other : properties)
            if (other.name == property.name) refuse(fmt::format("property {} is there twice", shown(words.back())));
        properties.push_back(std::move(property));
    }

    // The items.

    double value(Type type, std::string_view what, std::uint64_t item) {
        return binary_ ? binary_value(type, what, item) : text_value(what, item);
    }

    [[noreturn]] void refuse_end(std::string_view what, std::uint64_t item) const {
        refuse(fmt::format("the file ends in {} {}", what, item));
    }

    template <class Number>
    double bytes() {
        Number number{};
        std::memcpy(&number, rest_.data(), sizeof number);
        rest_.remove_prefix(sizeof number);
        return static_cast<double>(number);
    }

    double binary_value(Type type, std::string_view what, std::uint64_t item) {
        if (rest_.size() < size_of(type)) refuse_end(what, item);
        switch (type) {
            case Type::kInt8: return bytes<std::int8_t>();
            case Type::kUint8: return bytes<std::uint8_t>();
            case Type::kInt16: return bytes<std::int16_t>();
            case Type::kUint16: return bytes<std::uint16_t>();
            case Type::kInt32: return bytes<std::int32_t>();
            case Type::kUint32: return bytes<std::uint32_t>();
            case Type::kFloat: return bytes<float>();
            case Type::kDouble: return bytes<double>();
        }
        return 0.0;
    }

    double text_value(std::string_view what, std::uint64_t item) {
        const std::size_t begin = rest_.find_first_not_of(" \t\r\n");
        if (begin == std::string_view::npos) refuse_end(what, item);
        rest_.remove_prefix(begin);
        const std::size_t end = std::min(rest_.find_first_of(" \t\r\n"), rest_.size());
        double number = 0.0;
        const auto [stop, error] = std::from_chars(rest_.data(), rest_.data() + end, number);
        if (error != std::errc{} || stop != rest_.data() + end)
            refuse(fmt::format("{} {}: {} is no number", what, item, shown(rest_.substr(0, end))));
        rest_.remove_prefix(end);
        return number;
    }

    std::uint64_t length(const Property& property, std::string_view what, std::uint64_t item) {
        const double count = value(*property.count, what, item);
        const double most = static_cast<double>(rest_.size()) / (binary_ ? static_cast<double>(size_of(property.type)) : 1.0);
        if (!(count >= 0.0) || count != std::floor(count) || count > most)
            refuse(fmt::format("{} {}: a list of {} values does not fit into the file", what, item, count));
        return static_cast<std::uint64_t>(count);
    }

    /// Calls take(property, value) for each single value, take_list(property, count) at each list, whose values it reads.
    template <class Take, class TakeList>
    void item(const Element& element, std::uint64_t i, Take&& take, TakeList&& take_list) {
        for (const Property& property : element.properties) {
            if (property.count) take_list(property, length(property, element.name, i));
            else take(property, value(property.type, element.name, i));
        }
    }

    void skip_list(const Property& property, std::uint64_t count, std::string_view what, std::uint64_t i) {
        for (std::uint64_t k = 0; k < count; ++k) value(property.type, what, i);
    }

    void skip(const Element& element) {
        for (std::uint64_t i = 0; i < element.count; ++i)
            item(element, i, [](const Property&, double) {},
                 [&](const Property& p, std::uint64_t n) { skip_list(p, n, "an item of", i); });
    }

    static bool has(const Element& element, std::string_view name, bool list = false) {
        return std::any_of(element.properties.begin(), element.properties.end(), [&](const Property& p) {
            return p.name == name && p.count.has_value() == list;
        });
    }

    void vertices(const Element& element) {
        for (const char* axis : {"x", "y", "z"})
            if (!has(element, axis)) refuse(fmt::format("element vertex has no property {}", axis));
        for (std::uint64_t i = 0; i < element.count; ++i) {
            Vec3 at;
            bool held = false;
            item(
                element, i,
                [&](const Property& p, double v) {
                    if (p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z')
                        at[static_cast<std::size_t>(p.name[0] - 'x')] = v;
                    else if (p.name == "on_wire") held = v != 0.0;
                },
                [&](const Property& p, std::uint64_t n) { skip_list(p, n, "vertex", i); });
            for (std::size_t k = 0; k < 3; ++k)
                if (!std::isfinite(at[k])) refuse(fmt::format("vertex {} is not at a finite place", i));
            mesh_.add_vertex(at, held);
        }
    }

    RegionId region(double label, std::uint64_t i) {
        if (!(label >= 0.0) || label > static_cast<double>(detail::kMostRegions) || label != std::floor(label))
            refuse(fmt::format("face {} has region {}; regions are whole numbers from 0 to {}", i, label,
                               detail::kMostRegions));
        largest_ = std::max(largest_, static_cast<std::size_t>(label));
        return static_cast<RegionId>(static_cast<std::uint32_t>(label));
    }

    void faces(const Element& element) {
        const char* list = has(element, "vertex_indices", true) ? "vertex_indices" : "vertex_index";
        if (!has(element, list, true)) refuse("element face has no list vertex_indices");
        given_ = has(element, "region_back") && has(element, "region_front");
        for (std::uint64_t i = 0; i < element.count; ++i) {
            RegionId back = mesh::kNoRegion, front = mesh::kNoRegion;
            std::vector<double> loop;
            item(
                element, i,
                [&](const Property& p, double v) {
                    if (given_ && p.name == "region_back") back = region(v, i);
                    if (given_ && p.name == "region_front") front = region(v, i);
                },
                [&](const Property& p, std::uint64_t n) {
                    if (p.name != list) return skip_list(p, n, "face", i);
                    loop.reserve(n);
                    for (std::uint64_t k = 0; k < n; ++k) loop.push_back(value(p.type, "face", i));
                });
            add_face(loop, back, front, i);
        }
    }

    void add_face(const std::vector<double>& loop, RegionId back, RegionId front, std::uint64_t i) {
        if (loop.size() < 3) refuse(fmt::format("face {} has {} vertices; it needs 3 or more", i, loop.size()));
        std::vector<VertexId> corners;
        for (const double v : loop) {
            // A vertex that comes after the faces in the file is found in the audit.
            if (!(v >= 0.0) || v != std::floor(v) || v > 4e9) refuse(fmt::format("face {} has vertex {}", i, v));
            corners.push_back(static_cast<VertexId>(static_cast<std::uint32_t>(v)));
        }
        for (std::size_t k = 2; k < corners.size(); ++k) {
            mesh_.add_face(corners[0], corners[k - 1], corners[k], back, front);
            origin_.push_back(i);
        }
    }

    std::string_view rest_;
    const std::string& name_;
    bool binary_ = false;
    std::vector<Element> elements_;
    mesh::FoamMesh mesh_;
    bool given_ = false;
    std::size_t largest_ = 0;
    std::vector<std::uint64_t> origin_;  ///< of each triangle: the face of the file
};

}  // namespace

FilmFile parse_ply(std::string_view contents, const std::string& name) { return PlyParser(contents, name).parse(); }

}  // namespace lamella::io
