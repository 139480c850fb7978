// Pattern pieces of a DXF file, as the garment standards AAMA and ASTM D6673 write them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kernels/vec.h"

namespace icloth {

/// A line or polyline of a piece.
struct DxfLine {
  int layer = 0;
  bool closed = false;
  std::vector<Vec2d> points;  ///< in units of the file
};

/// A BLOCK. Layers: 1 cut line, 2 corners, 6 mirror line, 7 grain, 14 sew line, and others.
struct DxfPiece {
  std::string block;  ///< name of the BLOCK
  std::vector<DxfLine> lines;
  std::vector<Vec2d> corners;      ///< POINTs of layer 2
  std::vector<std::string> texts;  ///< such as "Piece Name: FRONT"
};

/// The pieces of an ASCII file. Entities outside of blocks are passed over. `name`: of the file,
/// for messages. Throws InputError with the number of the line.
std::vector<DxfPiece> read_dxf_pieces(std::string_view text, const std::string& name);

}  // namespace icloth
