#include "lamella/render/detail/ray_scene.h"

#include "lamella/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#ifdef LAMELLA_HAS_EMBREE
#include <embree3/rtcore.h>

#include <cstring>
#include <limits>
#endif

namespace lamella::render::detail {

#ifdef LAMELLA_HAS_EMBREE
namespace {

enum Geometry : unsigned { kFilms, kThreads, kBalls };  // their numbers in the scene
enum Mask : unsigned { kSeeThrough = 1, kOpaque = 2 };
constexpr float kStart = 1e-5F;  // rays begin this far from where they left

constexpr unsigned kPacket = 16;  // rays that Embree traces together

/// The notes of a packet of rays while they are on their way.
struct Context {
    RTCIntersectContext base;  // must come first: Embree hands out a pointer to it
    RayMeeting* meetings;      // of the packet's first ray
};

/// Notes the crossing and lets the ray go on. It may be told of films behind the thing that it hits in the end.
void cross_film(const RTCFilterFunctionNArguments* args) {
    const auto* context = reinterpret_cast<const Context*>(args->context);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        args->valid[i] = 0;
        context->meetings[RTCRayN_id(args->ray, args->N, i)].films.push_back(
            {RTCRayN_tfar(args->ray, args->N, i), RTCHitN_primID(args->hit, args->N, i),
             RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i)});
    }
}

/// For shadows: borders let light through.
void pass_border(const RTCFilterFunctionNArguments* args) {
    const auto* wire = static_cast<const std::uint8_t*>(args->geometryUserPtr);
    for (unsigned i = 0; i < args->N; ++i)
        if (args->valid[i] == -1 && wire[RTCHitN_primID(args->hit, args->N, i)] == 0) args->valid[i] = 0;
}

template <class Item>
Item* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<Item>& items) {
    auto* buffer = static_cast<Item*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Item), items.size()));
    if (buffer == nullptr) throw std::bad_alloc();
    std::memcpy(buffer, items.data(), sizeof(Item) * items.size());
    return buffer;
}

RTCRay make_ray(const Vec3& origin, const Vec3& direction, unsigned mask) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(origin[0]);
    ray.org_y = static_cast<float>(origin[1]);
    ray.org_z = static_cast<float>(origin[2]);
    ray.dir_x = static_cast<float>(direction[0]);
    ray.dir_y = static_cast<float>(direction[1]);
    ray.dir_z = static_cast<float>(direction[2]);
    ray.tnear = kStart;
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = mask;
    return ray;
}

void put(const RayStart& start, unsigned i, RTCRayHit16* packet) {
    RTCRay16& ray = packet->ray;
    ray.org_x[i] = static_cast<float>(start.origin[0]);
    ray.org_y[i] = static_cast<float>(start.origin[1]);
    ray.org_z[i] = static_cast<float>(start.origin[2]);
    ray.dir_x[i] = static_cast<float>(start.direction[0]);
    ray.dir_y[i] = static_cast<float>(start.direction[1]);
    ray.dir_z[i] = static_cast<float>(start.direction[2]);
    ray.tnear[i] = kStart;
    ray.tfar[i] = std::numeric_limits<float>::infinity();
    ray.time[i] = 0.0F;
    ray.mask[i] = kSeeThrough | kOpaque;
    ray.id[i] = i;
    ray.flags[i] = 0;
    packet->hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet->hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
}

/// Reads what the packet's i-th ray hit, and puts its films in order.
void finish(const RTCRayHit16& packet, unsigned i, const RayGeometry& geometry, RayMeeting* meeting) {
    std::vector<FilmCrossing>& films = meeting->films;
    meeting->thing = {};
    if (packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) {
        ThingHit& found = meeting->thing;
        const bool ball = packet.hit.geomID[i] == kBalls;
        found.number = packet.hit.primID[i];
        found.thing = ball ? Thing::kBall : geometry.segment_is_wire[found.number] != 0 ? Thing::kWire : Thing::kBorder;
        found.distance = packet.ray.tfar[i];
        const Vec3 normal{{packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]}};
        found.normal = normal / std::max(norm(normal), 1e-30);
        std::erase_if(films, [&](const FilmCrossing& c) { return c.distance >= found.distance; });
    }
    std::sort(films.begin(), films.end(), [](const FilmCrossing& a, const FilmCrossing& b) {
        return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
    });
    constexpr float kSame = 3e-6F;  // rays through an edge meet both triangles, at the same place to rounding
    const auto last = std::unique(films.begin(), films.end(), [](const FilmCrossing& a, const FilmCrossing& b) {
        return b.distance - a.distance < kSame;
    });
    films.erase(last, films.end());
}

}  // namespace

struct RayScene::Impl {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = nullptr;

    ~Impl() {
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }

    void attach(RTCGeometry geometry, unsigned number, unsigned mask) {
        rtcSetGeometryMask(geometry, mask);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, number);
        rtcReleaseGeometry(geometry);
    }
};

RayScene::RayScene(RayGeometry geometry) : geometry_(std::move(geometry)), impl_(std::make_unique<Impl>()) {
    if (impl_->device == nullptr) throw NumericalError("Embree cannot start");
    impl_->scene = rtcNewScene(impl_->device);
    if (!geometry_.film_triangles.empty()) {
        RTCGeometry films = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        new_buffer(films, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, geometry_.film_position);
        new_buffer(films, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, geometry_.film_triangles);
        rtcSetGeometryIntersectFilterFunction(films, cross_film);
        impl_->attach(films, kFilms, kSeeThrough);
    }
    if (!geometry_.thread_segments.empty()) {
        RTCGeometry threads = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
        new_buffer(threads, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, geometry_.thread_points);
        new_buffer(threads, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, geometry_.thread_segments);
        rtcSetGeometryUserData(threads, geometry_.segment_is_wire.data());
        rtcSetGeometryOccludedFilterFunction(threads, pass_border);
        impl_->attach(threads, kThreads, kSeeThrough | kOpaque);
    }
    if (!geometry_.balls.empty()) {
        RTCGeometry balls = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        new_buffer(balls, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, geometry_.balls);
        impl_->attach(balls, kBalls, kSeeThrough | kOpaque);
    }
    rtcCommitScene(impl_->scene);
    if (rtcGetDeviceError(impl_->device) != RTC_ERROR_NONE)
        throw NumericalError("Embree cannot build its tree of boxes");
}

RayScene::~RayScene() = default;

void RayScene::trace(std::span<const RayStart> rays, Bundle bundle, std::vector<RayMeeting>* meetings) const {
    if (meetings->size() < rays.size()) meetings->resize(rays.size());
    Context context{};
    rtcInitIntersectContext(&context.base);
    context.base.flags =
        bundle == Bundle::kAlike ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    for (std::size_t first = 0; first < rays.size(); first += kPacket) {
        const auto count = static_cast<unsigned>(std::min<std::size_t>(kPacket, rays.size() - first));
        context.meetings = &(*meetings)[first];
        RTCRayHit16 packet;
        alignas(64) std::array<int, kPacket> valid{};
        for (unsigned i = 0; i < count; ++i) {
            valid[i] = -1;
            put(rays[first + i], i, &packet);
            context.meetings[i].films.clear();
        }
        rtcIntersect16(valid.data(), impl_->scene, &context.base, &packet);
        for (unsigned i = 0; i < count; ++i) finish(packet, i, geometry_, &context.meetings[i]);
    }
}

bool RayScene::blocked(const Vec3& origin, const Vec3& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = make_ray(origin, direction, kOpaque);
    rtcOccluded1(impl_->scene, &context, &ray);
    return ray.tfar < 0.0F;
}

bool RayScene::meets_anything(const Vec3& origin, const Vec3& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = make_ray(origin, direction, kSeeThrough | kOpaque);
    rtcOccluded1(impl_->scene, &context, &ray);
    return ray.tfar < 0.0F;
}

bool can_trace_rays() { return true; }
#else
struct RayScene::Impl {};

RayScene::RayScene(RayGeometry) {
    throw InputError(
        "this lamella was built without Embree, which pictures need; install libembree-dev and build again");
}
RayScene::~RayScene() = default;
void RayScene::trace(std::span<const RayStart>, Bundle, std::vector<RayMeeting>*) const {}
bool RayScene::blocked(const Vec3&, const Vec3&) const { return false; }
bool RayScene::meets_anything(const Vec3&, const Vec3&) const { return false; }

bool can_trace_rays() { return false; }
#endif

}  // namespace lamella::render::detail
