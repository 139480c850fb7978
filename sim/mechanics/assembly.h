// Puts the linear system of the implicit step together from the shares of all forces.
#pragma once

#include <optional>
#include <vector>

#include "sim/linear/matrix_pattern.h"
#include "sim/mechanics/forces.h"

namespace icloth::ICLOTH_BUILD {

class Assembly {
 public:
  /// Lays out the matrix anew when the forces couple other vertices than before: one block for each
  /// pair of vertices that a face or an element of another force couples. Returns a new pattern.
  std::optional<Pattern> match_pattern(const World& world, const Topology& mesh);

  /// Lets the forces bring their own state to the shape x0.
  void begin_substep(SubstepContext& step);

  /// Writes matrix() and rhs() for a point of linearisation. Where it keeps faces, rows whose terms
  /// are all kept stay as they are.
  void assemble(const ForceContext& context);

  /// Work of the forces without a potential on the cloth from x0 to the candidate [J]. `dv`: the
  /// solution of the system that was assembled last.
  double work(const ForceContext& context, View<const Vec3r> dv) const;

  const Forces& forces() const { return forces_; }
  const BlockMatrix& matrix() const { return matrix_; }
  View<const Vec3r> rhs() const { return rhs_.view(); }  ///< 0 of held vertices (cloth_vertices)
  /// 1 where the last assembly has written the row, else 0 (cloth_vertices).
  View<const std::uint8_t> renewed_rows() const { return renewed_rows_.view(); }

 private:
  void assemble_faces(const ForceContext& context);

  Forces forces_;
  std::optional<std::vector<bool>> coupling_;  ///< Force::couples of each force, match_pattern
  BlockMatrix matrix_;
  ElementSources face_sources_;
  Array<FaceTerm> face_terms_;  ///< (cloth_faces), assemble_faces
  Array<Vec3r> rhs_;            ///< [N·s] (cloth_vertices), assemble
  Array<std::uint8_t> renewed_rows_;
};

}  // namespace icloth::ICLOTH_BUILD
