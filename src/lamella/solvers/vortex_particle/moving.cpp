// Films that move along their normals, with the flow in them.

#include "lamella/solvers/vortex_particle/moving.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/film/noise.h"
#include "lamella/film/surfactant.h"
#include "lamella/linalg/dense.h"
#include "lamella/mesh/staged_move.h"
#include "lamella/mesh/vertex_normals.h"
#include "lamella/mesh/volume_projection.h"
#include "lamella/sim/mesh_archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lamella::vortex_particle {

using mesh::FoamMesh;
using mesh::RegionId;
using mesh::VertexId;

namespace {

/// The two edges of a triangle from its first corner.
std::array<Vec3, 2> edges_of(const Surface& s, std::size_t t) { return {s.edge(t, 2), -s.edge(t, 1)}; }

/// The tangent vector along which one must go as far on the triangle as it lies now as `u` did along its former edges:
/// line integrals of a velocity, and with them circulations, stay what they are when the film moves under it.
Vec3 transported(const Vec3& u, const std::array<Vec3, 2>& before, const Surface& s, std::size_t t) {
    return dot(u, before[0]) * s.hat_slope[t][1] + dot(u, before[1]) * s.hat_slope[t][2];
}

/// Films with bumps along their normals, as `noise.shape` asks.
FoamMesh bumpy(FoamMesh mesh, const NoiseOptions& noise, double total_area, std::uint64_t seed) {
    if (noise.shape == 0.0) return mesh;
    constexpr std::uint64_t kShape = 1ULL << 63;  // thickness and surfactant have seeds of their own
    const double frequency = noise.frequency > 0.0 ? noise.frequency : 8.0 / std::sqrt(total_area);
    const IdVector<VertexId, Vec3> normal = mesh::film_normals(mesh, mesh::NormalWeight::kArea);
    for (const VertexId v : mesh.position.ids()) {
        if (mesh.on_wire[v] != 0) continue;
        const Vec3 x = frequency * mesh.position[v];
        mesh.position[v] += noise.shape * film::gradient_noise(x, 2 * seed + kShape, noise.octaves) * normal[v];
    }
    return mesh;
}

}  // namespace

/// @throws InputError  what goes with films at rest only
void VortexParticleSolver::check_moving() const {
    const film::Problem& films = *input_.films;
    const auto refuse = [](bool there, const char* what) {
        if (there) throw InputError(fmt::format("vortex_particle.moving = true: {} not built yet", what));
    };
    refuse(options_.transfer == Reach::kKernel, "transfer = \"kernel\" on films that move is");
    refuse(!films.tensions.empty(), "[[tension]] factors are");
    for (const film::Event& event : films.events)
        refuse(event.kind == film::Event::Kind::kInflate, "[[event]] of kind \"inflate\" is");
    refuse(norm(options_.stream.velocity) > 0.0, "stream.velocity of films that move is");
    const auto flies = [](const Vec3& velocity) { return norm(velocity) > 0.0; };
    refuse(!bodies_.empty() && std::any_of(films.velocity.begin(), films.velocity.end(), flies),
           "a [[solid]] on bubbles with a velocity is");
    for (const Body& body : bodies_) refuse(body.free, "a [[solid]] with free = true on films that move is");
    refuse(options_.walls == Walls::kNoSlip, "walls = \"no_slip\" on films that move is");
}

const FoamMesh& VortexParticleSolver::films() const { return moving_ ? moving_->films : input_.films->mesh; }

void VortexParticleSolver::start_moving() {
    take_films(bumpy(input_.films->mesh, options_.noise, surface_.total_area, input_.seed));
    settle_volumes();
    Moving& m = *moving_;
    m.pressure.assign(m.films.regions.size(), 0.0);
    m.velocity.assign(m.films.position.size(), {});
    m.carry.assign(m.films.position.size(), {});
    start_carry();
}

/// Bubbles of balls begin as polyhedra, and those with bumps have other volumes than their gas: they get theirs before
/// anything moves.
void VortexParticleSolver::settle_volumes() {
    constexpr double kSettled = 1e-12;  // relative
    constexpr int kMostRounds = 200;
    Moving& m = *moving_;
    for (int round = 0; round < kMostRounds; ++round) {
        const mesh::VolumeProjection projection = mesh::volume_projection(m.tracker->mesh());
        if (projection.error < kSettled) break;
        mesh::staged_move(*m.tracker, projection.displacement);
        if (options_.motion.remeshing) m.tracker->remesh();
    }
    m.tracker->take_events();
    take_films(m.tracker->mesh());
}

/// Everything that belongs to the films' triangles, for those of `mesh`.
void VortexParticleSolver::take_films(FoamMesh mesh) {
    surface_ = surface_of(mesh, options_.walls);
    transfer_ = Transfer(surface_, options_.transfer, options_.kernel_radius * surface_.longest_edge);
    flow_solver_ = FlowSolver(surface_, Films::kMoving);
    diffusion_ = Diffusion(surface_, Films::kMoving);
    compression_ = ShiftedStiffness(surface_, Films::kMoving);
    auto moving = std::make_unique<Moving>(mesh, surface_);
    if (moving_) {
        moving->velocity = std::move(moving_->velocity);
        moving->carry = std::move(moving_->carry);
        moving->pressure = std::move(moving_->pressure);
        moving->next_event = moving_->next_event;
        moving->tracker = std::move(moving_->tracker);
    } else {
        mesh::TrackerOptions options;
        options.edge_length = input_.films->edge_length;
        moving->tracker = std::make_unique<mesh::Tracker>(std::move(mesh), options);
    }
    if (options_.motion.added_air) {
        if (std::any_of(surface_.share.begin(), surface_.share.end(), [](double share) { return share != 1.0; }))
            throw InputError("vortex_particle.motion.added_air = true: films between two bubbles are not built yet");
        std::vector<std::uint8_t> still(surface_.vertices());
        for (std::size_t v = 0; v < still.size(); ++v) still[v] = moving->films.on_wire.values()[surface_.site[v]];
        moving->air.emplace(surface_, input_.films->material.air_density, still);
    }
    moving_ = std::move(moving);
    take_shape();
}

/// Clusters that the scene sends off go on as they are: the air carries them.
/// @throws InputError  bubbles that touch are sent different ways
void VortexParticleSolver::start_carry() {
    Moving& m = *moving_;
    const auto& velocity = input_.films->velocity;
    std::vector<std::uint8_t> known(m.membrane.clusters(), 0);
    std::vector<Vec3> carry(m.membrane.clusters());
    for (const mesh::Face& face : m.films.faces)
        for (const RegionId r : {face.back, face.front}) {
            if (m.films.regions[r].kind != mesh::RegionKind::kClosed || index(r) >= velocity.size()) continue;
            const std::uint32_t c = m.membrane.cluster()[index(face.vertices[0])];
            if (known[c] != 0 && norm(carry[c] - velocity[r]) > 0.0)
                throw InputError("vortex_particle: bubbles that touch need the same velocity");
            known[c] = 1;
            carry[c] = velocity[r];
        }
    for (const VertexId v : m.carry.ids())
        if (!m.membrane.held(m.membrane.cluster()[index(v)])) m.carry[v] = carry[m.membrane.cluster()[index(v)]];
}

/// The part of a step that the films' speed allows: a quarter of an edge along the normals, half of one in all; and no
/// event within.
double VortexParticleSolver::farthest_film_step() const {
    constexpr double kAlong = 0.25, kInAll = 0.5;  // of an edge
    const Moving& m = *moving_;
    double dt = options_.largest_step;
    for (const VertexId v : m.velocity.ids()) {
        const double along = norm(m.velocity[v]), all = norm(m.velocity[v] + m.carry[v]);
        if (along * dt > kAlong * surface_.mean_edge) dt = kAlong * surface_.mean_edge / along;
        if (all * dt > kInAll * surface_.mean_edge) dt = kInAll * surface_.mean_edge / all;
    }
    const auto& events = input_.films->events;
    if (m.next_event < events.size()) dt = std::min(dt, std::max(events[m.next_event].time - time_, 1e-3 * dt));
    return dt;
}

/// Puts the surface where the films are and takes along what lies on it: particles keep their places in the triangles,
/// their areas and what flows along the film follow the triangles' stretch.
/// @param along  more velocities of triangles to take along
void VortexParticleSolver::place_films(const Vectors& position, std::span<std::vector<Vec3>* const> along) {
    Moving& m = *moving_;
    std::vector<std::array<Vec3, 2>> edges(surface_.triangles());
    const std::vector<double> area = surface_.area;
    for (std::size_t t = 0; t < edges.size(); ++t) edges[t] = edges_of(surface_, t);
    m.films.position = position;
    place(position, options_.walls, surface_);
    parallel_for(particles_.size(), [&](std::size_t p) {
        const std::size_t t = particles_.triangle[p];
        particles_.area[p] *= surface_.area[t] / area[t];
        particles_.velocity[p] = transported(particles_.velocity[p], edges[t], surface_, t);
    });
    for (std::vector<Vec3>* velocity : along)
        for (std::size_t t = 0; t < velocity->size(); ++t)
            (*velocity)[t] = transported((*velocity)[t], edges[t], surface_, t);
    take_shape();
}

void VortexParticleSolver::drift(double dt, std::initializer_list<std::vector<Vec3>*> along) {
    Vectors position = moving_->films.position;
    for (const VertexId v : position.ids()) position[v] += dt * (moving_->velocity[v] + moving_->carry[v]);
    place_films(position, std::span(along.begin(), along.size()));
}

/// Of triangles, by the surfactant there; a film that is pressed together does not push. [N/m]
std::vector<double> VortexParticleSolver::film_tension(const MeshFlow& flow) const {
    const film::Material& material = input_.films->material;
    const film::SurfactantLaw law{material.surface_tension, film::start_surfactant(material), material.temperature};
    std::vector<double> tension(surface_.triangles());
    for (std::size_t t = 0; t < tension.size(); ++t) {
        tension[t] = surface_.share[t] * material.film_tension();
        if (options_.incompressible) continue;
        const auto& [a, b, c] = surface_.corner[t];
        tension[t] =
            surface_.share[t] *
            std::max(0.0, 2.0 * law.tension((flow.surfactant[a] + flow.surfactant[b] + flow.surfactant[c]) / 3.0));
    }
    return tension;
}

/// Of the liquid, at the vertices of the films [kg].
std::vector<double> VortexParticleSolver::film_mass(const MeshFlow& flow) const {
    std::vector<double> mass(moving_->films.position.size(), 0.0);
    for (std::size_t v = 0; v < surface_.vertices(); ++v)
        mass[surface_.site[v]] += input_.films->material.liquid_density * flow.thickness[v] * flow.area[v];
    return mass;
}

/// For each free cluster of films the vector z with sum_u A_u a_u (a_u . z) = sum_u value_u a_u over its unknowns u,
/// which have the directions a and the areas A; zero for clusters that a wire holds.
std::vector<Vec3> VortexParticleSolver::resultants(std::span<const double> value, std::span<const double> area) const {
    const Membrane& membrane = moving_->membrane;
    std::vector<Vec3> resultant(membrane.clusters());
    std::vector<std::array<double, 9>> square(membrane.clusters(), std::array<double, 9>{});
    for (std::size_t u = 0; u < membrane.size(); ++u) {
        const Vec3& n = membrane.along(u);
        const std::uint32_t c = membrane.cluster()[membrane.vertex(u)];
        resultant[c] += value[u] * n;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) square[c][3 * i + j] += area[u] * n[i] * n[j];
    }
    for (std::uint32_t c = 0; c < membrane.clusters(); ++c) {
        if (membrane.held(c)) {
            resultant[c] = {};
            continue;
        }
        const std::vector<double> z = linalg::solve_symmetric(3, square[c], std::span(resultant[c].v, 3)).x;
        resultant[c] = {{z[0], z[1], z[2]}};
    }
    return resultant;
}

/// Of the films, per unknown of the membrane [m^2].
std::vector<double> VortexParticleSolver::film_areas() const {
    std::vector<double> area(moving_->films.position.size(), 0.0);
    for (std::size_t v = 0; v < surface_.vertices(); ++v)
        area[surface_.site[v]] += surface_.vertex_share[v] * surface_.vertex_area[v];
    return moving_->membrane.values(area);
}

/// Tension and weight along the membrane's unknowns [N]. What would push a free cluster as a whole the air bears: its
/// weight, and what the films' tension leaves when it is seen along normals only, a small rest that the triangles make.
std::vector<double> VortexParticleSolver::film_forces(const std::vector<double>& mass,
                                                      const std::vector<double>& tension) const {
    const Membrane& membrane = moving_->membrane;
    Vectors force = tension_force(surface_, moving_->films.position.size(), tension);
    for (const VertexId v : force.ids()) force[v] += mass[index(v)] * input_.films->material.gravity;
    std::vector<double> along = membrane.components(force);
    const std::vector<double> area = film_areas();
    const std::vector<Vec3> push = resultants(along, area);
    for (std::size_t u = 0; u < membrane.size(); ++u)
        along[u] -= area[u] * dot(membrane.along(u), push[membrane.cluster()[membrane.vertex(u)]]);
    return along;
}

/// Free clusters do not move beside their steady motion: the air that carries them takes what liquid and films push.
void VortexParticleSolver::stay_with_air(std::vector<double>& speed) const {
    const Membrane& membrane = moving_->membrane;
    const std::vector<double> area = film_areas();
    std::vector<double> swept = speed;
    for (std::size_t u = 0; u < swept.size(); ++u) swept[u] *= area[u];
    const std::vector<Vec3> mean = resultants(swept, area);
    for (std::size_t u = 0; u < membrane.size(); ++u)
        speed[u] -= dot(membrane.along(u), mean[membrane.cluster()[membrane.vertex(u)]]);
}

/// Tension, gas and weight act, with the surfactant that the films stretch.
/// @returns  theta* at vertices [1/s]
std::vector<double> VortexParticleSolver::kick_films(double dt, MeshFlow& flow) {
    Moving& m = *moving_;
    m.membrane.aim(m.films);
    const std::vector<double> tension = film_tension(flow), mass = film_mass(flow);
    constexpr double kOther = 1.5;  // ratio of steps whose factors still do for each other
    const double ratio = m.reference.step > 0.0 ? dt / m.reference.step : 0.0;
    if (m.reference.stale || !(ratio < kOther && ratio > 1.0 / kOther)) {
        m.reference = {dt, false, m.films.position, flow.thickness, flow.surfactant, mass, tension};
        factor_moving();
    }
    m.membrane.assemble(surface_, mass, tension, dt);
    fit_air(dt, mass, tension);
    std::vector<double> speed = m.membrane.speeds(m.velocity);
    for (double& v : speed) v *= std::exp(-options_.motion.damping * dt);
    const SurfactantProblem surfactant = options_.incompressible ? SurfactantProblem{} : surfactant_problem(dt, flow);
    KickStep step = kick({.mesh = m.films,
                          .surface = surface_,
                          .membrane = m.membrane,
                          .dt = dt,
                          .speed = std::move(speed),
                          .force = film_forces(mass, tension),
                          .pressure = m.pressure,
                          .share = outward_signs(),
                          .air = m.air ? &*m.air : nullptr,
                          .surfactant = options_.incompressible ? nullptr : &surfactant,
                          .tolerance = options_.solve_tolerance});
    constexpr int kSlow = 20;
    m.reference.stale = step.iterations > kSlow || flow_solver_.take_iterations() > kSlow;
    note_iterations(step.iterations, step.residual);
    stay_with_air(step.speed);
    m.velocity = m.membrane.velocities(step.speed);
    m.pressure = step.pressure;
    std::vector<double> dilatation(surface_.vertices(), 0.0);
    for (std::size_t v = 0; v < step.surfactant.size(); ++v)
        dilatation[v] =
            -step.surfactant[v] / (dt * flow.surfactant[v]) - 0.5 * step.stretch[v] / surface_.vertex_area[v];
    take_dilatation(dilatation, flow);
    return dilatation;
}

/// +1 where the membrane's direction is that of the surface's normal, -1 where it is the other; 0 on triple lines.
std::vector<double> VortexParticleSolver::outward_signs() const {
    const Moving& m = *moving_;
    Vectors along(m.films.position.size());
    for (std::size_t u = 0; u < m.membrane.size(); ++u) along.values()[m.membrane.vertex(u)] = m.membrane.along(u);
    std::vector<double> sign(surface_.vertices());
    for (std::size_t v = 0; v < sign.size(); ++v)
        sign[v] = dot(along.values()[surface_.site[v]], surface_.vertex_normal[v]) < 0.0 ? -1.0 : 1.0;
    return sign;
}

/// Factors all equations for the reference, at whose place the surface must be.
void VortexParticleSolver::factor_moving() {
    Moving& m = *moving_;
    const Moving::Reference& r = m.reference;
    flow_solver_.factorize(surface_);
    std::vector<double> mass(surface_.vertices());
    if (!options_.incompressible) {
        std::vector<double> weight(surface_.triangles());
        for (std::size_t t = 0; t < weight.size(); ++t) {
            const auto& [a, b, c] = surface_.corner[t];
            weight[t] = 3.0 * surface_.share[t] / (r.thickness[a] + r.thickness[b] + r.thickness[c]);
        }
        for (std::size_t v = 0; v < mass.size(); ++v) mass[v] = surface_.vertex_area[v] / (r.step * r.surfactant[v]);
        compression_.factorize(surface_, r.step * surfactant_strength_, weight, mass);
    }
    if (viscosity_ > 0.0) diffusion_.factorize(surface_, viscosity_ * r.step);
    if (m.air) return m.air->factorize(surface_);
    m.membrane.aim(m.films);
    m.membrane.assemble(surface_, r.mass, r.tension, r.step);
    m.membrane.factorize();
}

/// What one step takes of the air: its inverse for a film that is as heavy and tense everywhere as in the mean.
void VortexParticleSolver::fit_air(double dt, const std::vector<double>& mass, const std::vector<double>& tension) {
    if (!moving_->air) return;
    double heavy = 0.0, tense = 0.0;
    for (const double m : mass) heavy += m / surface_.total_area;
    for (std::size_t t = 0; t < tension.size(); ++t) tense += tension[t] * surface_.area[t] / surface_.total_area;
    moving_->air->fit_inverse(heavy, 0.25 * dt * dt * tense);
}

/// As `diffuse`, with factors of another step.
void VortexParticleSolver::diffuse_moving(double dt, MeshFlow& flow) const {
    if (options_.viscosity == Viscosity::kSurface && !curvature_.empty()) {
        const std::vector<double> stream = flow_solver_.stream_function(surface_, flow.circulation, hole_circulation_);
        add_stiffness(surface_, -2.0 * viscosity_ * dt, curvature_, stream, flow.circulation);
    }
    for (std::vector<double>* cells : {&flow.circulation, &flow.outflow})
        diffusion_.spread_lagging(surface_, viscosity_ * dt, *cells);
}

double VortexParticleSolver::film_energy() const {
    if (!moving_) return 0.0;
    const Moving& m = *moving_;
    const std::vector<double> mass = film_mass(observed());
    double sum = 0.0;
    for (const VertexId v : m.velocity.ids()) sum += 0.5 * mass[index(v)] * squared_norm(m.velocity[v] + m.carry[v]);
    if (m.air && m.reference.step > 0.0) {
        std::vector<double> speed(surface_.vertices()), momentum(surface_.vertices(), 0.0);
        for (std::size_t v = 0; v < speed.size(); ++v) {
            const Vec3& u = m.velocity.values()[surface_.site[v]];
            speed[v] = std::copysign(norm(u), dot(u, surface_.vertex_normal[v]));
        }
        m.air->add(speed, momentum);
        for (std::size_t v = 0; v < speed.size(); ++v) sum += 0.5 * speed[v] * momentum[v];
    }
    return sum;
}

}  // namespace lamella::vortex_particle
