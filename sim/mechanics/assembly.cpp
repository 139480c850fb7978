#include "sim/mechanics/assembly.h"

#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Gathers one row of the matrix and of the right-hand side in a fixed order. `Shares`: a Bundle of
/// the row shares of all forces.
template <class Shares>
struct AssembleRow {
  View<const Index> row_first, column;
  View<const Real> mass, inverse_mass;
  Vec3r gravity;
  Real dt;
  FaceRows faces;
  Shares shares;
  View<Mat3r> value;
  View<Vec3r> rhs;
  View<std::uint8_t> renewed;  ///< becomes 1 where a row is written, else 0

  /// Whether a term of the row is another one than in the iteration before.
  ICLOTH_HD bool changes(Index i) const {
    const Index diagonal = row_first[i];  // comes first
    bool any = faces.renews(diagonal);
    shares.each([&](const auto& share) { any = any || share.renews(diagonal); });
    return any;
  }

  ICLOTH_HD void operator()(Index i) const {
    const bool writes = faces.renewed.size() == 0 || changes(i);
    renewed[i] = writes ? 1 : 0;
    if (!writes) return;

    Vec3r impulse = (dt * mass[i]) * gravity;
    for (Index k = row_first[i]; k < row_first[i + 1]; ++k) {
      const RowBlock at{i, k, column[k] == i};
      Mat3r sum = at.diagonal ? Mat3r::identity(mass[i]) : Mat3r{};
      faces.add(at, sum, impulse);
      shares.each([&](const auto& share) { share.add(at, sum, impulse); });
      value[k] = sum;
    }
    rhs[i] = inverse_mass[i] > 0 ? impulse : Vec3r{};
  }
};

}  // namespace

std::optional<Pattern> Assembly::match_pattern(const World& world, const Topology& mesh) {
  std::vector<bool> coupling;
  forces_.each([&](const auto& force) { coupling.push_back(force.couples(mesh)); });
  if (coupling_ == coupling) return std::nullopt;
  coupling_ = coupling;

  // Each face couples its corners, and forces add the elements that they have besides.
  PatternBuilder builder;
  builder.begin_elements(face_sources_);
  for (Index f = 0; f < world.cloth_faces; ++f)
    builder.add_element(f, world.face[static_cast<std::size_t>(f)]);
  forces_.each([&](auto& force) { force.lay_out(world, mesh, builder); });

  Pattern pattern = builder.finish(world.cloth_vertices);
  matrix_.set_pattern(pattern.row_first, pattern.column);
  return pattern;
}

void Assembly::begin_substep(SubstepContext& step) {
  forces_.each([&](auto& force) { force.begin_substep(step.mesh, step.parameters, step.state); });
}

void Assembly::assemble_faces(const ForceContext& context) {
  const Topology& mesh = context.mesh;
  face_terms_.resize(mesh.cloth_faces);

  // All forces add to a face in one pass, so that its data are loaded once.
  auto shares = forces_.bundle([&](const auto& force) { return force.face_share(context); });
  for_each("implicit.faces", mesh.cloth_faces,
           FacePass<decltype(shares)>{.face = mesh.face.view(),
                                      .inverse = mesh.face_inverse.view(),
                                      .area = mesh.face_area.view(),
                                      .face_fabric = mesh.face_fabric.view(),
                                      .fabric = mesh.fabric.view(),
                                      .point = context.point,
                                      .term = face_terms_.view(),
                                      .shares = shares});
}

void Assembly::assemble(const ForceContext& context) {
  assemble_faces(context);
  forces_.each([&](auto& force) { force.prepare(context); });

  // A row gathers the terms of its faces and elements in a fixed order, which needs no atomics.
  const Topology& mesh = context.mesh;
  const State& s = context.state;
  const GravityParameters& g = context.parameters.gravity;
  auto shares = forces_.bundle([&](const auto& force) { return force.row_share(context); });
  rhs_.resize(mesh.cloth_vertices);
  renewed_rows_.resize(mesh.cloth_vertices);
  for_each("implicit.assemble", mesh.cloth_vertices,
           AssembleRow<decltype(shares)>{
               .row_first = matrix_.row_first.view(),
               .column = matrix_.column.view(),
               .mass = s.mass.view(),
               .inverse_mass = s.inverse_mass.view(),
               .gravity = convert<Real>(Vec3d{g.x, g.y, g.z}),
               .dt = context.point.dt,
               .faces = {face_sources_.view<3>(), face_terms_.view(), context.point.renewed},
               .shares = shares,
               .value = matrix_.value.view(),
               .rhs = rhs_.view(),
               .renewed = renewed_rows_.view()});
}

double Assembly::work(const ForceContext& context, View<const Vec3r> dv) const {
  double sum = 0;
  forces_.each([&](const auto& force) { sum += force.work(context, dv); });
  return sum;
}

}  // namespace icloth::ICLOTH_BUILD
