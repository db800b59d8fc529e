#include "lamella/mesh/detail/face_grid.h"

#include <bit>

namespace lamella::mesh::detail {

FaceGrid::FaceGrid(double cell, std::size_t faces) : inverse_cell_(1.0 / cell) { clear(faces); }

void FaceGrid::clear(std::size_t faces) {
    const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(faces, 64));
    mask_ = buckets - 1;
    for (auto& bucket : buckets_) bucket.clear();
    buckets_.resize(buckets);
    boxes_.clear();
    present_.clear();
}

/// Two cells of a box may share a bucket: a face stands in it once.
template <class Visit>
void FaceGrid::for_each_bucket(const Box& box, Visit&& visit) {
    const Range r = range(box);
    for (std::int32_t z = r.low[2]; z <= r.high[2]; ++z)
        for (std::int32_t y = r.low[1]; y <= r.high[1]; ++y)
            for (std::int32_t x = r.low[0]; x <= r.high[0]; ++x) visit(buckets_[bucket(x, y, z)]);
}

void FaceGrid::insert(FaceId face, const Box& box) {
    if (index(face) >= boxes_.size()) {
        boxes_.resize(index(face) + 1);
        present_.resize(index(face) + 1, 0);
    }
    boxes_[face] = box;
    present_[face] = 1;
    for_each_bucket(box, [&](auto& bucket) {
        if (!bucket.contains(face)) bucket.push_back(face);
    });
}

void FaceGrid::erase(FaceId face) {
    present_[face] = 0;
    for_each_bucket(boxes_[face], [&](auto& bucket) {
        for (std::size_t i = 0; i < bucket.size(); ++i)
            if (bucket[i] == face) {
                bucket[i] = bucket.back();
                bucket.pop_back();
                return;
            }
    });
}

}  // namespace lamella::mesh::detail
