#include "lamella/solvers/vortex_particle/vortex_particle_solver.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/film/bursting.h"
#include "lamella/film/surfactant.h"
#include "lamella/linalg/conjugate_gradient.h"
#include "lamella/solvers/vortex_particle/exchange.h"
#include "lamella/solvers/vortex_particle/moving.h"
#include "lamella/solvers/vortex_particle/solids.h"
#include "lamella/solvers/vortex_particle/start.h"
#include "lamella/solvers/vortex_particle/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lamella::vortex_particle {
namespace {

const film::Problem& films_of(const sim::SolverInput& input) {
    if (!input.films) throw InputError("the scene has no films; add a [[bubble]], [[film]] or [foam]");
    film::refuse_what_melp_alone_knows(*input.films, "vortex_particle");
    return *input.films;
}

/// 1/eta of triangles, from the mean of their corners.
std::vector<double> inverse_thickness(const Surface& s, std::span<const double> leaves) {
    const std::vector<double> thickness = whole_thickness(s, leaves);
    std::vector<double> inverse(s.triangles());
    parallel_for(s.triangles(), [&](std::size_t t) {
        const auto& [a, b, c] = s.corner[t];
        inverse[t] = 3.0 / (thickness[a] + thickness[b] + thickness[c]);
    });
    return inverse;
}

}  // namespace

VortexParticleSolver::VortexParticleSolver(const Options& options, const sim::SolverInput& input)
    : options_(options),
      input_(input),
      surfactant_strength_(2.0 * film::thermal_energy(films_of(input).material) / input.films->material.liquid_density),
      viscosity_(film::film_viscosity(input.films->material)),
      surface_(surface_of(input.films->mesh, options.walls, options.stream.velocity, options.junction)),
      stream_(surface_, *input.films, options, input.seed),
      transfer_(surface_, options.transfer, options.kernel_radius * surface_.longest_edge),
      flow_solver_(surface_),
      diffusion_(surface_),
      compression_(surface_),
      bodies_(film::bodies_at_start(input.films->solids)) {
    film::start_surfactant(input_.films->material);
    if (options_.walls == Walls::kNoSlip && viscosity_ == 0.0)
        throw InputError("vortex_particle.walls = \"no_slip\" needs material.kinematic_viscosity or surface_viscosity");
    if (!input_.films->events.empty() && !options_.moving)
        throw InputError("vortex_particle: [[event]] tables need films that move: vortex_particle.moving = true");
    if (options_.junction == Junction::kSheets && (options_.moving || norm(options_.stream.velocity) > 0.0))
        throw InputError(
            "vortex_particle.junction = \"sheets\" with moving = true or a stream is not built yet; use \"leaves\"");
    for (const film::Wire& wire : input_.films->wires)
        if (wire.moves() || (wire.ring && wire.ring->blow != 0.0))
            throw InputError("vortex_particle: wires that move or blow are not built yet");
    if (options_.moving) check_moving();
    check_solids();
    take_shape();
}

/// @throws InputError  free ones that are too light or where they could not stay in a plane
void VortexParticleSolver::check_solids() const {
    constexpr double kPi = 3.14159265358979323846;
    const film::Material& material = input_.films->material;
    for (const Body& body : bodies_) {
        if (norm(body.arm) > 0.0) throw InputError("vortex_particle: solid.arm is for solver melp; a stick here is a ball");
        if (!body.wet) throw InputError("vortex_particle: solid.wet = false is for solver melp");
        if (!body.free) continue;
        const double around = 2.0 * kPi * body.radius * body.radius * material.liquid_density * material.thickness;
        if (body.mass < around)
            throw InputError(
                fmt::format("vortex_particle: a free solid lighter than the film that it moves, {:.3g} kg, is not "
                            "built yet; raise solid.mass",
                            around));
        for (const Vec3& n : surface_.normal)
            if (dot(n, surface_.normal[0]) < 1.0 - 1e-9)
                throw InputError("vortex_particle: a solid with free = true on a curved film is not built yet");
    }
}

/// What follows from where the surface lies: its curvature, and gravity along it.
void VortexParticleSolver::take_shape() {
    const std::vector<double> curvature = gaussian_curvature(surface_);
    const double most = std::abs(*std::max_element(curvature.begin(), curvature.end(),
                                                   [](double a, double b) { return std::abs(a) < std::abs(b); }));
    curvature_.clear();
    if (most * surface_.total_area > 1e-6) curvature_ = curvature;
    std::vector<Vec3> gravity(surface_.triangles());
    for (std::size_t t = 0; t < gravity.size(); ++t) {
        const Vec3& g = input_.films->material.gravity;
        gravity[t] = g - dot(g, surface_.normal[t]) * surface_.normal[t];
    }
    gravity_ = divergence(surface_, gravity);
}

VortexParticleSolver::~VortexParticleSolver() = default;

void VortexParticleSolver::start(const sim::StartContext&) {
    if (options_.moving) start_moving();
    particles_ = start_particles(surface_, transfer_, *input_.films, options_, input_.seed);
    bins_ = sort_by_triangle(particles_, surface_.triangles());
    hole_circulation_ = hole_circulation(surface_, input_.films->vortices);
    velocity_.assign(surface_.triangles(), {});
    MeshFlow flow = particles_to_mesh();
    recover_velocity(flow);
    velocity_ = flow.velocity;
    for (std::size_t p = 0; p < particles_.size(); ++p) particles_.velocity[p] = velocity_[particles_.triangle[p]];
    if (moving_) apply_events();
}

/// [Tao24, section 4], in the form of the method sheet's section 5.
sim::StepReport VortexParticleSolver::advance(double time_limit) {
    const double left = time_limit - time_;
    const double dt = choose_step(left);
    if (moving_) drift(0.5 * dt, {&velocity_});
    const MeshFlow before = particles_to_mesh();
    MeshFlow flow = before;
    drag(dt, flow);
    drive_circulation(dt, flow);
    const std::vector<double> dilatation = moving_ ? kick_films(dt, flow) : compress(dt, flow);
    hold_walls(flow);
    diffuse(dt, flow);
    recover_velocity(flow);
    obey_solids(dt, flow);
    mesh_to_particles(dt, before, flow, dilatation);
    if (moving_) drift(0.5 * dt, {&velocity_, &flow.velocity});
    move_particles(dt, flow);
    velocity_ = std::move(flow.velocity);
    time_ = left <= dt * (1.0 + 1e-9) ? time_limit : time_ + dt;
    step_ = dt;
    ++steps_;
    if (moving_) settle_films();
    observed_.reset();
    look_for_rupture();
    return {.step = dt, .evaluations = 1, .iterations = iterations_};
}

/// Equal steps until the limit, none longer than speed and compression allow.
double VortexParticleSolver::choose_step(double left) const {
    double crossings = 0.0;  // of edges per time
    for (std::size_t t = 0; t < velocity_.size(); ++t)
        crossings = std::max(crossings, norm(velocity_[t]) / surface_.edge_length(t));
    const double told = std::max(film::fastest(input_.films->solids), norm(stream_.velocity()));
    crossings = std::max(crossings, told / surface_.mean_edge);
    constexpr double kMostCompression = 0.5;  // |theta| dt [method sheet 14]
    double dt = options_.largest_step;
    if (moving_) dt = std::min(dt, farthest_film_step());
    if (crossings > 0.0) dt = std::min(dt, options_.courant / crossings);
    if (fastest_dilatation_ > 0.0) dt = std::min(dt, kMostCompression / fastest_dilatation_);
    if (!std::isfinite(crossings) || dt < 1e-6 * options_.largest_step)
        throw NumericalError(
            fmt::format("vortex_particle: at {} s, step {}, the flow runs away: {} edges/s, dilatation {} 1/s", time_,
                        steps_, crossings, fastest_dilatation_));
    dt = left / std::ceil(left / dt - 1e-9);
    constexpr double kSame = 1e-9;  // steps that differ by rounding are one step, and share their matrices
    return std::abs(dt - step_) < kSame * dt ? step_ : dt;
}

MeshFlow VortexParticleSolver::particles_to_mesh() const {
    Deposit sum = transfer_.deposit(surface_, particles_, bins_);
    MeshFlow flow{.circulation = std::move(sum.circulation),
                  .thickness = std::move(sum.volume),
                  .surfactant = std::move(sum.amount),
                  .area = std::move(sum.area),
                  .outflow = {},
                  .velocity = triangle_velocity(surface_, particles_, bins_, velocity_)};
    for (std::size_t v = 0; v < surface_.vertices(); ++v)
        if (!(flow.area[v] > 0.0))
            throw NumericalError(fmt::format("vortex_particle: at {} s, step {}, no particle is left around vertex {}",
                                             time_, steps_, v));
    std::vector<double> area = flow.area;
    for (std::vector<double>* column : {&flow.thickness, &flow.surfactant, &area}) add_up_joints(surface_, *column);
    for (std::size_t v = 0; v < surface_.vertices(); ++v) {
        flow.thickness[v] /= area[v];
        flow.surfactant[v] /= area[v];
    }
    flow.outflow = divergence(surface_, stream_.relative(flow.velocity));
    return flow;
}

void VortexParticleSolver::drag(double dt, MeshFlow& flow) const {
    if (options_.air_drag == 0.0) return;
    const double left = std::exp(-options_.air_drag * dt);
    for (double& value : flow.circulation) value *= left;
    for (double& value : flow.outflow) value *= left;
}

/// Where surfactant per liquid is uneven its pull turns the film, gravity along closed loops never does.
/// [Tao24, eq. 14]
void VortexParticleSolver::drive_circulation(double dt, MeshFlow& flow) {
    if (options_.incompressible) return;
    const std::vector<double> thickness = whole_thickness(surface_, flow.thickness);
    const std::vector<double> torque = surfactant_torque(surface_, flow.surfactant, thickness, surfactant_strength_);
    for (std::size_t v = 0; v < torque.size(); ++v) flow.circulation[v] += dt * torque[v];
    const std::vector<double> around = wall_torque(surface_, flow.surfactant, thickness, surfactant_strength_);
    for (std::size_t l = 0; l < around.size(); ++l) hole_circulation_[l] -= dt * around[l];
}

/// Surfactant at the end of the step, which resists compression: with Gamma* - Gamma = -dt Gamma theta*,
///
///     [diag(A_i / (dt Gamma_i)) + (2 R T dt / rho) K_(1/eta)] (Gamma* - Gamma) = -D - dt G - (2 R T dt / rho)
///     K_(1/eta) Gamma
///
/// G_i the weak divergence of gravity. [Tao24, eq. 16; method sheet 5.4]
SurfactantProblem VortexParticleSolver::surfactant_problem(double dt, const MeshFlow& flow) const {
    SurfactantProblem problem{.mass = std::vector<double>(surface_.vertices()),
                              .weight = inverse_thickness(surface_, flow.thickness),
                              .stiffness = dt * surfactant_strength_,
                              .right = std::vector<double>(surface_.vertices()),
                              .energy = surfactant_strength_ * input_.films->material.liquid_density,
                              .factors = &compression_};
    for (std::size_t v = 0; v < problem.mass.size(); ++v) {
        problem.mass[v] = surface_.vertex_area[v] / (dt * flow.surfactant[v]);
        problem.right[v] = -flow.outflow[v] - dt * gravity_[v];
    }
    add_stiffness(surface_, -problem.stiffness, problem.weight, flow.surfactant, problem.right);
    return problem;
}

/// @returns theta* at vertices [1/s]
std::vector<double> VortexParticleSolver::compress(double dt, MeshFlow& flow) {
    std::vector<double> dilatation(surface_.vertices(), 0.0);
    iterations_ = 0;
    if (!options_.incompressible) {
        const SurfactantProblem problem = surfactant_problem(dt, flow);
        const VertexMatrix& unknowns = compression_.unknowns();
        const auto apply = [&](const std::vector<double>& x, std::vector<double>& y) {
            const std::vector<double> change = unknowns.spread(x);
            std::vector<double> image(change.size());
            for (std::size_t v = 0; v < image.size(); ++v) image[v] = problem.mass[v] * change[v];
            add_stiffness(surface_, problem.stiffness, problem.weight, change, image);
            y = unknowns.sums(image);
        };
        const auto precondition = [&](const std::vector<double>& x, std::vector<double>& y) {
            y = x;
            compression_.solve(y);
        };
        if (reference_.step != dt) refresh_reference(dt, flow);
        constexpr int kMostIterations = 200, kSlow = 12;
        std::vector<double> x(unknowns.size(), 0.0);
        const linalg::IterativeSolution done = linalg::preconditioned_conjugate_gradient(
            apply, precondition, unknowns.sums(problem.right), x, options_.solve_tolerance, kMostIterations);
        note_iterations(done.iterations, done.residual);
        if (done.iterations > kSlow) reference_.step = 0.0;  // the next step factors anew
        const std::vector<double> change = unknowns.spread(x);
        for (std::size_t v = 0; v < dilatation.size(); ++v) dilatation[v] = -change[v] / (dt * flow.surfactant[v]);
    }
    take_dilatation(dilatation, flow);
    return dilatation;
}

/// @throws NumericalError  the surfactant's equation was not solved
void VortexParticleSolver::note_iterations(int iterations, double residual) {
    iterations_ = iterations;
    if (!(residual < std::sqrt(options_.solve_tolerance)))
        throw NumericalError(
            fmt::format("vortex_particle: at {} s, step {}, the surfactant's equation has a residual "
                        "of {} after {} iterations",
                        time_, steps_, residual, iterations));
}

void VortexParticleSolver::take_dilatation(const std::vector<double>& dilatation, MeshFlow& flow) {
    fastest_dilatation_ = 0.0;
    for (std::size_t v = 0; v < dilatation.size(); ++v) {
        flow.outflow[v] = surface_.vertex_area[v] * dilatation[v];
        fastest_dilatation_ = std::max(fastest_dilatation_, std::abs(dilatation[v]));
    }
}

void VortexParticleSolver::refresh_reference(double dt, const MeshFlow& flow) {
    reference_ = {dt, flow.thickness, flow.surfactant};
    factor_reference();
}

void VortexParticleSolver::factor_reference() {
    std::vector<double> mass(surface_.vertices());
    for (std::size_t v = 0; v < mass.size(); ++v)
        mass[v] = surface_.vertex_area[v] / (reference_.step * reference_.surfactant[v]);
    compression_.factorize(surface_, reference_.step * surfactant_strength_,
                           inverse_thickness(surface_, reference_.thickness), mass);
}

/// Walls without slip hold the film: in the cells at them lies as much circulation as makes the velocity there zero, so
/// the walls' own stretches of their loops give none and Omega = curl u. Viscosity then spreads it. [method sheet 6.2]
void VortexParticleSolver::hold_walls(MeshFlow& flow) {
    if (options_.walls == Walls::kSlip) return;
    recover_velocity(flow);
    const std::vector<double> held = curl(surface_, flow.velocity);
    for (std::size_t v = 0; v < surface_.vertices(); ++v)
        if (surface_.loop[v] >= 0 && surface_.place[v] != Place::kInside) flow.circulation[v] = held[v];
    std::fill(hole_circulation_.begin(), hole_circulation_.end(), 0.0);
}

/// (M + nu dt K) omega = Omega, and the same for the dilatation; on curved films the vorticity has a source besides,
/// 2 nu div(K_G grad Psi), without which a bubble could not rotate as a whole for long. [method sheet 5.5]
void VortexParticleSolver::diffuse(double dt, MeshFlow& flow) {
    if (viscosity_ == 0.0) return;
    if (moving_) return diffuse_moving(dt, flow);
    if (diffusion_step_ != dt) {
        diffusion_.factorize(surface_, viscosity_ * dt);
        diffusion_step_ = dt;
    }
    if (options_.viscosity == Viscosity::kSurface && !curvature_.empty()) {
        const std::vector<double> stream = flow_solver_.stream_function(surface_, flow.circulation, hole_circulation_);
        add_stiffness(surface_, -2.0 * viscosity_ * dt, curvature_, stream, flow.circulation);
    }
    for (std::vector<double>* cells : {&flow.circulation, &flow.outflow}) diffusion_.spread(surface_, *cells);
}

Cover VortexParticleSolver::cover(double dt) const { return cover_of(surface_, bodies_, std::sqrt(viscosity_ * dt)); }

void VortexParticleSolver::recover_velocity(MeshFlow& flow) const {
    flow.velocity =
        rotated_gradient(surface_, flow_solver_.stream_function(surface_, flow.circulation, hole_circulation_));
    const std::vector<Vec3> away = gradient(surface_, flow_solver_.potential(surface_, flow.outflow));
    for (std::size_t t = 0; t < away.size(); ++t) flow.velocity[t] += away[t] + stream_.velocity();
}

/// In a solid the film moves with it. What would give it the solid's velocity goes into the circulation alone, and so
/// gets around the solid what it cannot compress; sweeps until the film inside obeys to a hundredth. The circulation
/// that is added sums to zero: what a solid sheds it keeps the opposite of. [method sheet 6.3]
void VortexParticleSolver::obey_solids(double dt, MeshFlow& flow) {
    if (bodies_.empty()) return;
    constexpr int kSweeps = 24;
    constexpr double kObeyed = 0.01;  // of what moves fastest
    film::move_bodies(input_.films->solids, time_ + dt, dt, bodies_);
    double speed = std::max(film::fastest(input_.films->solids), norm(stream_.velocity()));
    std::vector<double> mass(surface_.triangles());
    for (std::size_t t = 0; t < mass.size(); ++t) {
        const auto& [a, b, c] = surface_.corner[t];
        const double thickness = (flow.thickness[a] + flow.thickness[b] + flow.thickness[c]) / 3.0;
        mass[t] = input_.films->material.liquid_density * thickness * surface_.area[t];
    }
    for (const Body& body : bodies_)
        if (body.free) speed = std::max(speed, norm(body.velocity));
    Grip grip(surface_, cover(dt), std::move(mass), bodies_, input_.films->material.gravity, dt);
    const std::vector<double> none(surface_.loops.size(), 0.0);
    std::vector<Vec3> change(surface_.triangles());
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        const double worst = grip.sweep(flow.velocity, change);
        const std::vector<double> more = closed_curl(surface_, change);
        for (std::size_t v = 0; v < more.size(); ++v) flow.circulation[v] += more[v];
        const std::vector<Vec3> swirl = rotated_gradient(surface_, flow_solver_.stream_function(surface_, more, none));
        for (std::size_t t = 0; t < swirl.size(); ++t) flow.velocity[t] += swirl[t];
        if (worst <= kObeyed * speed) break;
    }
    grip.finish();
}

/// What the particles have to take over so that they put `spin` [1/s] more on the vertices: their areas times it, and
/// once again what is missing then. Without that second look narrow swirls would change too little, by 5 % where they
/// are five edges across.
std::vector<double> VortexParticleSolver::particle_circulation(const MeshFlow& flow, std::vector<double> spin) const {
    if (std::all_of(spin.begin(), spin.end(), [](double w) { return w == 0.0; }))
        return std::vector<double>(particles_.size(), 0.0);
    std::vector<double> circulation = transfer_.gather(surface_, particles_, spin);
    for (std::size_t p = 0; p < circulation.size(); ++p) circulation[p] *= particles_.area[p];
    const std::vector<double> put = transfer_.deposit(surface_, particles_, bins_, circulation);
    for (std::size_t v = 0; v < spin.size(); ++v) spin[v] -= put[v] / flow.area[v];
    const std::vector<double> more = transfer_.gather(surface_, particles_, spin);
    for (std::size_t p = 0; p < circulation.size(); ++p) circulation[p] += particles_.area[p] * more[p];
    return circulation;
}

/// By how much the logarithm of particles' areas grows at each vertex so that they fit the room that there is; empty:
/// nowhere. What a film that burst has left lies on its borders with the area that it had, far more than there is, and
/// goes into the films as that shrinks; differences that the flow makes by itself are smaller.
std::vector<double> VortexParticleSolver::area_growth(double dt, const MeshFlow& flow) const {
    constexpr double kUsual = 0.2;
    const double relaxed = -std::expm1(-options_.area_relaxation * dt);
    const double released = moving_ ? -std::expm1(-options_.border_release * dt) : 0.0;
    if (relaxed == 0.0 && released == 0.0) return {};
    std::vector<double> growth(surface_.vertices());
    for (std::size_t v = 0; v < growth.size(); ++v) {
        const double room = std::log(surface_.vertex_area[v] / flow.area[v]);
        growth[v] = relaxed * room + released * (room - std::clamp(room, -kUsual, kUsual));
    }
    return transfer_.gather(surface_, particles_, growth);
}

/// Particles take over changes, not values: what the mesh cannot see of them stays [Tao24, eq. 21]. Velocities follow
/// slowly what it does see. Areas need not: a thickness that drifted is carried by the liquid, which is conserved (a
/// blend as in the method sheet's 12.10, tried, makes thickness of thick and thin neighbors alike and liquid out of
/// nothing).
void VortexParticleSolver::mesh_to_particles(double dt,
                                             const MeshFlow& before,
                                             const MeshFlow& after,
                                             const std::vector<double>& dilatation) {
    std::vector<double> spin(surface_.vertices());
    for (std::size_t v = 0; v < spin.size(); ++v)
        spin[v] = (after.circulation[v] - before.circulation[v]) / before.area[v];
    const std::vector<Vec3> smooth = vertex_velocity(surface_, after.velocity);
    const double followed = -std::expm1(-options_.velocity_blend * dt);
    const std::vector<double> turn = particle_circulation(before, spin), growth = area_growth(dt, before);
    parallel_for(particles_.size(), [&](std::size_t p) {
        const std::size_t t = particles_.triangle[p];
        const auto& [a, b, c] = surface_.corner[t];
        const auto& at = particles_.place[p];
        particles_.circulation[p] += turn[p];
        particles_.velocity[p] += after.velocity[t] - before.velocity[t];
        const Vec3 mesh = at[0] * smooth[a] + at[1] * smooth[b] + at[2] * smooth[c];
        Vec3& u = particles_.velocity[p];
        u += followed * (mesh - u);
        u -= dot(u, surface_.normal[t]) * surface_.normal[t];
        const double theta = at[0] * dilatation[a] + at[1] * dilatation[b] + at[2] * dilatation[c];
        particles_.area[p] *= std::exp(theta * dt + (growth.empty() ? 0.0 : growth[p]));
    });
}

/// With the velocity of the middle of the step, as the last two tell [method sheet 12.11].
void VortexParticleSolver::move_particles(double dt, const MeshFlow& flow) {
    std::vector<Vec3> velocity = flow.velocity;
    if (options_.tracer == Tracer::kExtrapolated && steps_ > 0) {
        const double ahead = 0.5 * dt / step_;
        for (std::size_t t = 0; t < velocity.size(); ++t) velocity[t] += ahead * (velocity[t] - velocity_[t]);
    }
    const Draw draw{input_.seed, static_cast<std::uint64_t>(steps_) + 1};  // 0 has placed the particles
    trace(surface_, vertex_velocity(surface_, velocity), dt, particles_, draw);
    if (surface_.open()) exchange_with_stream(dt);
    bins_ = sort_by_triangle(particles_, surface_.triangles());
    fill_empty_triangles(surface_, particles_, bins_);
    merge_crowds(surface_, most_per_triangle(), particles_, bins_);
    exchange_between_leaves(surface_, bins_, options_.leaf_exchange * dt, particles_);
}

/// Never fewer than splitting makes.
std::size_t VortexParticleSolver::most_per_triangle() const {
    const int most = options_.most_per_triangle > 0 ? options_.most_per_triangle : 4 * options_.particles_per_triangle;
    return static_cast<std::size_t>(std::max(2, most));
}

void VortexParticleSolver::exchange_with_stream(double dt) {
    liquid_out_ += remove_gone(particles_);
    liquid_in_ += stream_.let_in(dt, steps_, particles_);
    stream_.absorb(dt, particles_);
}

}  // namespace lamella::vortex_particle
