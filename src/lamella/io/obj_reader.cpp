#include "lamella/core/error.h"
#include "lamella/io/detail/evolver_datafile.h"
#include "lamella/io/detail/film_labels.h"
#include "lamella/io/mesh_files.h"
#include "lamella/mesh/label_sides.h"
#include "lamella/sim/node.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

namespace lamella::io {
namespace {

using mesh::RegionId;
using mesh::VertexId;

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    constexpr std::string_view kSpace = " \t\r\f\v";
    for (std::size_t at = line.find_first_not_of(kSpace); at != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(kSpace, at), line.size());
        words.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(kSpace, end);
    }
    return words;
}

std::string shown(std::string_view word) { return sim::quoted_text(word.substr(0, 40)); }

template <class Number>
std::optional<Number> number_from(std::string_view word) {
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    return value;
}

/// Regions of a group film_B_F.
std::optional<std::array<RegionId, 2>> film_group(std::string_view name) {
    constexpr std::string_view kPrefix = "film_";
    if (!name.starts_with(kPrefix)) return std::nullopt;
    name.remove_prefix(kPrefix.size());
    const std::size_t middle = name.find('_');
    if (middle == std::string_view::npos) return std::nullopt;
    const auto back = number_from<std::int64_t>(name.substr(0, middle));
    const auto front = number_from<std::int64_t>(name.substr(middle + 1));
    if (!back || !front) return std::nullopt;
    for (const std::int64_t r : {*back, *front})
        if (r < 0 || r > detail::kMostRegions) return std::nullopt;
    return std::array{static_cast<RegionId>(*back), static_cast<RegionId>(*front)};
}

class ObjParser {
public:
    explicit ObjParser(const std::string& name) : name_(name) {}

    FilmFile parse(std::string_view text) {
        while (!text.empty()) {
            ++line_;
            const std::size_t end = std::min(text.find('\n'), text.size());
            statement(words_of(text.substr(0, std::min(text.find('#'), end))));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        const mesh::ElementNames names{[](VertexId v) { return std::to_string(index(v) + 1); },
                                       [this](mesh::FaceId f) { return face_name(f); }};
        if (labelled_faces_ != 0 && labelled_faces_ != mesh_.faces.size())
            refuse("some faces are in groups film_B_F and some are not");
        const bool given = labelled_faces_ > 0;
        if (given) {
            mesh_.regions.resize(index(largest_) + 1, {mesh::RegionKind::kOpen, 0.0});
            for (const VertexId v : held_) mesh_.on_wire[v] = 1;
        }
        detail::complete_films(mesh_, given ? detail::Labels::kGiven : detail::Labels::kMissing, name_, names);
        FilmFile films;
        films.mesh = std::move(mesh_);
        return films;
    }

private:
    [[noreturn]] void refuse(const std::string& what) const { throw InputError({name_, line_, 0}, what); }

    void statement(const std::vector<std::string_view>& words) {
        if (words.empty()) return;
        const std::string_view what = words[0];
        // Textures, normals, materials and lines say nothing about films.
        constexpr std::array<std::string_view, 7> kIgnored{"vt", "vn", "s", "o", "usemtl", "mtllib", "l"};
        if (what == "v") vertex(words);
        else if (what == "f") face(words);
        else if (what == "g") group(words);
        else if (what == "p") points(words);
        else if (std::find(kIgnored.begin(), kIgnored.end(), what) == kIgnored.end())
            refuse(fmt::format("{} is not supported; v, f, g and p are", shown(what)));
    }

    void vertex(const std::vector<std::string_view>& words) {
        if (words.size() < 4) refuse(fmt::format("vertex {} needs 3 coordinates", mesh_.position.size() + 1));
        Vec3 at;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto x = number_from<double>(words[k + 1]);
            if (!x || !std::isfinite(*x))
                refuse(fmt::format("vertex {}: {} is no finite number", mesh_.position.size() + 1, shown(words[k + 1])));
            at[k] = *x;
        }
        mesh_.add_vertex(at);
    }

    /// "7", "7/1", "7//3", "-1": counted from 1, or back from the last vertex.
    VertexId vertex_at(std::string_view word, const std::string& in) const {
        const auto number = number_from<std::int64_t>(word.substr(0, word.find('/')));
        const auto count = static_cast<std::int64_t>(mesh_.position.size());
        const std::int64_t place = !number ? -1 : *number < 0 ? count + *number : *number - 1;
        if (!number || place < 0 || place >= count)
            refuse(fmt::format("{} has vertex {} of {}", in, number ? std::to_string(*number) : shown(word), count));
        return static_cast<VertexId>(place);
    }

    void face(const std::vector<std::string_view>& words) {
        const std::string in = fmt::format("face {}", ++faces_);
        if (words.size() < 4) refuse(fmt::format("{} has {} vertices; it needs 3 or more", in, words.size() - 1));
        std::vector<VertexId> loop;
        for (std::size_t k = 1; k < words.size(); ++k) loop.push_back(vertex_at(words[k], in));
        if (regions_) labelled_faces_ += loop.size() - 2;
        const RegionId back = regions_ ? (*regions_)[0] : mesh::kNoRegion;
        const RegionId front = regions_ ? (*regions_)[1] : mesh::kNoRegion;
        for (std::size_t k = 2; k < loop.size(); ++k) {
            mesh_.add_face(loop[0], loop[k - 1], loop[k], back, front);
            origin_.push_back(faces_);
        }
    }

    void group(const std::vector<std::string_view>& words) {
        regions_ = words.size() > 1 ? film_group(words[1]) : std::nullopt;
        wire_ = words.size() > 1 && words[1] == "wire";
        if (!regions_ && words.size() > 1 && words[1].starts_with("film_"))
            refuse(fmt::format("group {}: film_B_F has two regions from 0 to {}", shown(words[1]), detail::kMostRegions));
        if (regions_) largest_ = std::max({largest_, (*regions_)[0], (*regions_)[1]});
    }

    void points(const std::vector<std::string_view>& words) {
        for (std::size_t k = 1; wire_ && k < words.size(); ++k) held_.push_back(vertex_at(words[k], "the wire"));
    }

    std::string face_name(mesh::FaceId f) const { return std::to_string(origin_[index(f)]); }

    const std::string& name_;
    int line_ = 0;
    mesh::FoamMesh mesh_;
    std::optional<std::array<RegionId, 2>> regions_;
    bool wire_ = false;
    RegionId largest_ = mesh::kOutside;
    std::vector<VertexId> held_;
    std::size_t faces_ = 0;           ///< of the file
    std::size_t labelled_faces_ = 0;  ///< triangles
    std::vector<std::size_t> origin_; ///< of each triangle: the face of the file, from 1
};

}  // namespace

FilmFile parse_obj(std::string_view text, const std::string& name) { return ObjParser(name).parse(text); }

}  // namespace lamella::io
