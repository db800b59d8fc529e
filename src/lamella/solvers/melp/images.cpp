#include "lamella/solvers/melp/images.h"

#include "lamella/core/parallel.h"
#include "lamella/solvers/melp/point_grid.h"

#include <algorithm>

namespace lamella::melp {
namespace {

constexpr double kAgreeing = 0.2;  // least cosine between normals of one film

struct Found {
    std::uint32_t source, mirror;
    double square;  // mean squared distance [m^2]
    double root;    // of the narrowing, of the two pictures together
};

const Mirror* with_key(std::span<const Mirror> mirrors, std::uint32_t key) {
    const auto it = std::find_if(mirrors.begin(), mirrors.end(), [&](const Mirror& m) { return m.key == key; });
    return it == mirrors.end() ? nullptr : &*it;
}

}  // namespace

Images find_images(std::span<const RimPiece> pieces,
                   std::span<const Vec3> position,
                   std::span<const Vec3> normal,
                   std::span<const std::int32_t> region,
                   double support_radius) {
    Images images;
    if (pieces.empty()) return images;
    const std::size_t count = position.size();
    // Pictures of each particle, `first[i]` to `first[i + 1]`.
    std::vector<std::uint32_t> first{0};
    std::vector<std::uint32_t>& source = images.source;
    std::vector<Vec3> place;
    for (std::size_t i = 0; i < count; ++i) {
        append_mirrors(pieces, region[i], position[i], normal[i], support_radius, images.mirrors);
        for (std::size_t m = first.back(); m < images.mirrors.size(); ++m) {
            source.push_back(static_cast<std::uint32_t>(i));
            place.push_back(images.mirrors[m].place(position[i]));
        }
        first.push_back(static_cast<std::uint32_t>(images.mirrors.size()));
    }
    const PointGrid grid(place, 0.5 * support_radius);
    // Pictures behind curved rims are not quite as far from i as that of i is from their particles.
    constexpr double kWider = 1.3;
    const double reach = support_radius * support_radius;
    std::vector<std::vector<Found>> rows(count);
    parallel_blocks(count, 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto mine = std::span(images.mirrors).subspan(first[i], first[i + 1] - first[i]);
            if (mine.empty()) continue;
            grid.for_each_near(position[i], kWider * support_radius, [&](std::uint32_t m) {
                const std::uint32_t j = source[m];
                const Mirror* back = with_key(mine, images.mirrors[m].key);
                if (region[i] != region[j] || back == nullptr) return;
                const double square =
                    0.5 * (squared_norm(position[i] - place[m]) + squared_norm(position[j] - back->place(position[i])));
                if (square >= reach) return;
                const double agree = 0.5 * (dot(normal[i], images.mirrors[m].normal(normal[j])) +
                                            dot(normal[j], back->normal(normal[i])));
                if (agree > kAgreeing) rows[i].push_back({j, m, square, images.mirrors[m].root * back->root});
            });
            std::sort(rows[i].begin(), rows[i].end(), [](const Found& a, const Found& b) {
                return a.source != b.source ? a.source < b.source : a.mirror < b.mirror;
            });
        }
    });
    const FilmKernel kernel{support_radius};
    images.start.push_back(0);
    for (const auto& row : rows) {
        for (const Found& f : row) {
            images.index.push_back(f.source);
            images.follow.push_back(f.root);
            images.mirror.push_back(f.mirror);
            images.weight.push_back(f.root * kernel.value(f.square));
            images.laplacian.push_back(f.root * kernel.laplacian_weight(f.square));
            images.place.push_back(place[f.mirror]);
            images.normal.push_back(images.mirrors[f.mirror].normal(normal[f.source]));
        }
        images.start.push_back(static_cast<std::uint32_t>(images.index.size()));
    }
    return images;
}

}  // namespace lamella::melp
