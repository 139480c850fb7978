// Body files of other formats than glTF that somebody made to break their reader.
#pragma once

#include <string>
#include <vector>

#include "tests/app/cli/hostile_gltf.h"

#if defined(ICLOTH_HAS_ZLIB)
#include <zlib.h>
#endif

namespace icloth {

/// Bytes that look like nothing, the same ones each time.
inline std::string noise(std::size_t count, std::uint32_t seed) {
  std::string bytes;
  for (std::size_t k = 0; k < count; ++k) {
    seed = seed * 1664525u + 1013904223u;
    bytes += static_cast<char>(seed >> 24);
  }
  return bytes;
}

inline std::string collada(const std::string& geometry, const std::string& nodes = "") {
  return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\"><library_geometries><geometry id=\"g\"><mesh>" +
         geometry +
         "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"v\">"
         "<node id=\"r\"><instance_geometry url=\"#g\"/>" +
         nodes +
         "</node></visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#v\"/>"
         "</scene></COLLADA>";
}

/// A mesh of Collada with these positions, their announced number and these indices.
inline std::string collada_mesh(const std::string& floats, const std::string& count,
                                const std::string& indices, const std::string& stride = "3") {
  return "<source id=\"s\"><float_array id=\"a\" count=\"" + count + "\">" + floats +
         "</float_array><technique_common><accessor source=\"#a\" count=\"3\" stride=\"" + stride +
         "\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" "
         "type=\"float\"/></accessor></technique_common></source><vertices id=\"w\"><input "
         "semantic=\"POSITION\" source=\"#s\"/></vertices><triangles count=\"1\"><input "
         "semantic=\"VERTEX\" source=\"#w\" offset=\"0\"/><p>" +
         indices + "</p></triangles>";
}

inline const std::string kNineFloats = "0 0 0 1 0 0 0 1 0";

/// XML: nesting, references that go round, counts and indices.
inline void add_xml(std::vector<HostileFile>& files) {
  constexpr std::size_t kDeep = 200000;
  const std::string good = collada_mesh(kNineFloats, "9", "0 1 2");
  files.push_back(
      {"deep.dae", collada(good, repeated("<node>", kDeep) + repeated("</node>", kDeep))});
  files.push_back({"deep.x3d", "<X3D><Scene>" + repeated("<Group>", kDeep)});
  files.push_back({"deep.amf", "<amf>" + repeated("<object>", kDeep)});
  files.push_back({"deep.irr", "<irr_scene>" + repeated("<node type=\"empty\">", kDeep)});
  files.push_back({"deep.xgl", "<WORLD>" + repeated("<OBJECT>", kDeep)});
  files.push_back({"deep.mesh.xml", "<mesh>" + repeated("<submeshes>", kDeep)});
  files.push_back({"round.dae", collada(good, "<instance_node url=\"#r\"/>")});
  files.push_back({"unclosed.dae", collada(good).substr(0, 300)});
  files.push_back({"laughs.dae", "<!DOCTYPE a [<!ENTITY a \"" + repeated("b", 9) +
                                     "\"><!ENTITY c \"" + repeated("&a;", 9) +
                                     "\">]><COLLADA>&c;</COLLADA>"});
  files.push_back({"index.dae", collada(collada_mesh(kNineFloats, "9", "0 1 4000000000"))});
  files.push_back({"negative.dae", collada(collada_mesh(kNineFloats, "9", "0 1 -2"))});
  files.push_back({"few_floats.dae", collada(collada_mesh("0 0 0", "9", "0 1 2"))});
  files.push_back({"many_floats.dae", collada(collada_mesh(kNineFloats, "4200000000", "0 1 2"))});
  files.push_back({"stride.dae", collada(collada_mesh(kNineFloats, "9", "0 1 2", "1000000000"))});
  files.push_back({"nan.dae", collada(collada_mesh("nan inf 0 1 0 0 0 1 0", "9", "0 1 2"))});
  files.push_back({"no_source.dae", collada("<vertices id=\"w\"><input semantic=\"POSITION\" "
                                            "source=\"#none\"/></vertices>")});
  files.push_back({"binary.dae", "<COLLADA>" + noise(500, 1)});
}

/// A motion of three joints with one channel each.
inline std::string motion_text(const std::string& root, const std::string& frames,
                               const std::string& numbers) {
  const std::string block = "{\nOFFSET 0 1 0\nCHANNELS 1 Xrotation\n";
  return "HIERARCHY\nROOT " + root + "\n" + block + "JOINT knee\n" + block + "JOINT tail\n" +
         block + "}\n}\n}\nMOTION\nFrames: " + frames + "\nFrame Time: 0.1\n" + numbers;
}

/// Motions for a body with the nodes "hip" and "knee".
inline void add_motions(std::vector<HostileFile>& files) {
  const std::string zeros = "0 0 0\n";
  const auto add = [&](const char* name, const std::string& text) {
    files.push_back({std::string(name) + ".bvh", text});
  };
  add("two_partners", motion_text("hip", "1", zeros));
  add("no_partner", motion_text("a", "1", zeros));
  add("negative_frames", motion_text("hip", "-1", zeros));
  add("many_frames", motion_text("hip", "4000000000", zeros));
  add("large_frames", motion_text("hip", "1e300", zeros));
  add("frames_without_numbers", motion_text("hip", "2", zeros));
  add("more_numbers", motion_text("hip", "1", zeros + zeros));
  add("nan", motion_text("hip", "1", "0 nan 0\n"));
  add("far", motion_text("hip", "1", "0 1e300 0\n"));
  add("words", motion_text("hip", "1", "a b c\n"));
  add("no_joints", "HIERARCHY\nMOTION\nFrames: 1\nFrame Time: 0.1\n0\n");
  add("no_channels", "HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\n}\nMOTION\nFrames: 1\n");
  add("channels", "HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\nCHANNELS 400000000 Xrotation\n}\n");
  add("open", "HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\n");
  add("deep", "HIERARCHY\nROOT a\n{\n" + repeated("JOINT a\n{\n", 500000));
  add("many_ends", "HIERARCHY\nROOT a\n{\n" + repeated("End Site\n{\n}\n", 500000));
  add("long_name", "HIERARCHY\nROOT " + std::string(1000000, 'a') + "\n{\n");
  add("empty", "");
  add("zeros", std::string(1000000, '\0'));
  add("noise", "HIERARCHY\n" + noise(4000, 11));
}

/// The head of a binary FBX file, and one node of it with nothing in it but these bytes.
inline std::string binary_fbx(const std::string& nodes) {
  return std::string("Kaydara FBX Binary  \0\x1a\0", 23) + u32(7400) + nodes;
}
inline std::string fbx_node(std::uint64_t end, std::uint64_t properties, std::uint64_t bytes,
                            const std::string& name, const std::string& content) {
  return u32(end) + u32(properties) + u32(bytes) + static_cast<char>(name.size()) + name + content;
}

/// FBX as text and in binary.
inline void add_fbx(std::vector<HostileFile>& files) {
  const std::string head = "; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXVersion: 7400\n}\n";
  const auto mesh = [&](const std::string& vertices, const std::string& indices) {
    return head + "Objects: {\nGeometry: 1, \"Geometry::g\", \"Mesh\" {\nVertices: " + vertices +
           "\nPolygonVertexIndex: " + indices + "\n}\n}\n";
  };
  files.push_back({"deep_text.fbx", head + repeated("A: {\n", 200000)});
  files.push_back({"closed_too_often.fbx", head + repeated("}\n", 1000)});
  files.push_back({"many_vertices.fbx", mesh("*4200000000 {\na: 0,0,0\n}", "*3 {\na: 0,1,-3\n}")});
  files.push_back({"index.fbx", mesh("*9 {\na: 0,0,0,1,0,0,0,1,0\n}", "*3 {\na: 0,1,-400\n}")});
  files.push_back({"no_end.fbx", mesh("*9 {\na: 0,0,0", "")});
  files.push_back({"long_token.fbx", head + std::string(1000000, 'A')});

  // A node says where it ends and how many bytes its properties take.
  files.push_back({"end.fbx", binary_fbx(fbx_node(0xfffffff0, 0, 0, "Objects", ""))});
  files.push_back({"backwards.fbx", binary_fbx(fbx_node(5, 0, 0, "Objects", ""))});
  files.push_back({"property.fbx", binary_fbx(fbx_node(100, 1, 0xfffffff0, "A", "S"))});
  files.push_back(
      {"array.fbx", binary_fbx(fbx_node(70, 1, 13, "A", "d" + u32(0xfffffff) + u32(0) + u32(4)))});
  std::string nested;
  for (std::size_t depth = 0; depth < 60000; ++depth)
    nested += fbx_node(27 + 60000 * 14, 0, 0, "A", "");
  files.push_back({"deep_binary.fbx", binary_fbx(nested + std::string(14, '\0'))});
  files.push_back({"noise.fbx", binary_fbx(noise(4000, 2))});
}

/// Formats of text: counts that ask for much, nesting, numbers that are none.
inline void add_texts(std::vector<HostileFile>& files) {
  files.push_back({"spheres.nff", "tess 15\ns 0 0 0 1\ns 0 0 1 1\n"});
  files.push_back({"cones.nff", "tess 100000000\nc 0 0 0 1 0 1 0 1\n"});
  files.push_back({"polygon.nff", "p 400000000\n0 0 0\n"});
  files.push_back({"counts.off", "OFF\n4000000000 4000000000 0\n0 0 0\n"});
  files.push_back({"nan.off", "OFF\n3 1 0\nnan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"});
  files.push_back({"corners.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n400000000 0 1 2\n"});
  files.push_back(
      {"deep.bvh", "HIERARCHY\nROOT a\n" + repeated("{ OFFSET 0 0 0 JOINT a\n", 200000)});
  files.push_back({"frames.bvh",
                   "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition "
                   "Zposition\n}\nMOTION\nFrames: 4000000000\nFrame Time: 0.1\n0 0 0\n"});
  files.push_back(
      {"channels.bvh", "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 400000000 Xposition\n}"});
  files.push_back({"motion_alone.bvh", "MOTION\nFrames: 1\nFrame Time: nan\n0\n"});
  files.push_back({"deep.x", "xof 0303txt 0032\n" + repeated("Frame a {\n", 200000)});
  files.push_back({"counts.x", "xof 0303txt 0032\nMesh { 4000000000; 0;0;0;, 1; 3;0,1,2;; }\n"});
  files.push_back({"deep.wrl", "#VRML V2.0 utf8\n" + repeated("Group{children[", 200000)});
  files.push_back({"deep.ogex", repeated("GeometryNode {", 200000)});
  files.push_back({"deep.ase", "*3DSMAX_ASCIIEXPORT 200\n" + repeated("*GEOMOBJECT {\n", 100000)});
  files.push_back({"counts.ase",
                   "*3DSMAX_ASCIIEXPORT 200\n*GEOMOBJECT {\n*MESH {\n*MESH_NUMVERTEX "
                   "4000000000\n*MESH_NUMFACES 4000000000\n}\n}\n"});
  files.push_back({"deep.ac", "AC3Db\n" + repeated("OBJECT world\nkids 1\n", 100000)});
  files.push_back({"counts.ac", "AC3Db\nOBJECT poly\nnumvert 4000000000\n0 0 0\n"});
  files.push_back(
      {"counts.md5mesh", "MD5Version 10\nnumJoints 4000000000\nnumMeshes 4000000000\n"});
  files.push_back(
      {"nodes.smd", "version 1\nnodes\n0 \"a\" 0\nend\nskeleton\ntime -5\n0 0 0 0 0 0 0\nend\n"});
  files.push_back({"sections.dxf",
                   "0\nSECTION\n2\nENTITIES\n0\nPOLYLINE\n71\n4000000000\n72\n"
                   "4000000000\n0\nVERTEX\n10\nnan\n"});
  files.push_back({"numbers.raw", "0 0 0 1 0 0 x y z\n"});
  files.push_back({"facets.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n"});
  files.push_back({"lines.ifc", "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=IFCSITE(" +
                                    repeated("(", 100000) + ");\nENDSEC;\n"});
  files.push_back({"counts.ply",
                   "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\n"
                   "property float y\nproperty float z\nend_header\n0 0 0\n"});
  files.push_back({"index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4000000000\n"});
}

/// Formats of binary numbers: the mark of each, and then lengths that are as large as they can be.
inline void add_binaries(std::vector<HostileFile>& files) {
  const struct {
    const char *name, *mark;
  } formats[] = {
      {"a.md2", "IDP2\10"},
      {"a.md3", "IDP3\17"},
      {"a.mdc", "IDPC\2"},
      {"a.mdl", "IDPO\6"},
      {"a.lwo", "FORM"},
      {"a.lxo", "FORM"},
      {"a.b3d", "BB3D"},
      {"a.blend", "BLENDER-v248"},
      {"a.cob", "Caligari V00.01BLH"},
      {"a.hmp", "HMP7"},
      {"a.ms3d", "MS3D000000\4"},
      {"a.q3o", "quick3Do"},
      {"a.q3s", "quick3Ds"},
      {"a.ter", "TERRAGENTERRAIN "},
      {"a.ndo", "nendo 1.2"},
      {"a.sib", "SIB\1"},
      {"a.3ds", "MM"},
      {"a.assbin", "ASSIMP.binary-dump."},
      {"a.iqm", "INTERQUAKEMODEL"},
      {"a.m3d", "3DMO"},
      {"a.pmx", "PMX "},
      {"a.x", "xof 0303bin 0032"},
      {"a.mesh", "\0\20[Serializer"},
      {"a.bsp", "IBSP"},
  };
  for (const auto& format : formats) {
    files.push_back({format.name, format.mark + std::string(400, '\xff')});
    files.push_back({std::string("noise_") + format.name, format.mark + noise(2000, 7)});
  }
  files.push_back({"triangles.stl", std::string(80, ' ') + u32(4000000000u) + noise(100, 3)});
  std::string chunks;
  for (int depth = 0; depth < 5000; ++depth) chunks += "MM" + u32(0x7fffffff);
  files.push_back({"deep.3ds", chunks});
}

/// The entry of an archive that claims to be so large when it is unpacked.
inline std::string make_zip(const std::string& name, const std::string& packed, bool deflated,
                            std::uint64_t unpacked, std::uint64_t checksum) {
  const std::string facts = u16(deflated ? 8 : 0) + u16(0) + u16(0) + u32(checksum) +
                            u32(packed.size()) + u32(unpacked) + u16(name.size()) + u16(0);
  const std::string local = "PK\3\4" + u16(20) + u16(0) + facts + name + packed;
  const std::string central = "PK\1\2" + u16(20) + u16(20) + u16(0) + facts + u16(0) + u16(0) +
                              u16(0) + u32(0) + u32(0) + name;
  return local + central + "PK\5\6" + u16(0) + u16(0) + u16(1) + u16(1) + u32(central.size()) +
         u32(local.size()) + u16(0);
}

#if defined(ICLOTH_HAS_ZLIB)
/// A stream of deflate, or a gzip file, of so many equal letters.
inline std::string packed_letters(std::size_t count, bool gzip, unsigned long& checksum) {
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, gzip ? 31 : -15, 9, Z_DEFAULT_STRATEGY);
  std::string piece(1 << 20, ' '), out(1 << 20, '\0'), packed;
  checksum = crc32(0, nullptr, 0);
  for (std::size_t done = 0; done < count; done += piece.size()) {
    const bool is_last = done + piece.size() >= count;
    checksum = crc32(checksum, reinterpret_cast<const Bytef*>(piece.data()),
                     static_cast<uInt>(piece.size()));
    stream.next_in = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_in = static_cast<uInt>(piece.size());
    do {
      stream.next_out = reinterpret_cast<Bytef*>(out.data());
      stream.avail_out = static_cast<uInt>(out.size());
      deflate(&stream, is_last ? Z_FINISH : Z_NO_FLUSH);
      packed.append(out, 0, out.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  }
  deflateEnd(&stream);
  return packed;
}
#endif

/// Archives: with sizes that are lies, and with sizes that are true.
inline void add_archives(std::vector<HostileFile>& files) {
  const struct {
    const char *file, *entry;
  } formats[] = {
      {"3mf", "3D/3dmodel.model"}, {"zae", "a.dae"}, {"pk3", "maps/a.bsp"}, {"ifczip", "a.ifc"}};
  for (const auto& format : formats)
    files.push_back({std::string("lie.") + format.file,
                     make_zip(format.entry, std::string(100, ' '), false, 0xfffffff0, 0)});
  files.push_back({"no_directory.3mf", "PK\3\4" + noise(300, 5)});
#if defined(ICLOTH_HAS_ZLIB)
  constexpr std::size_t kBomb = std::size_t{3} << 29;  // 1.5 GB from 1.5 MB
  unsigned long checksum = 0;
  const std::string bomb = packed_letters(kBomb, false, checksum);
  for (const auto& format : formats)
    files.push_back(
        {std::string("bomb.") + format.file, make_zip(format.entry, bomb, true, kBomb, checksum)});
  files.push_back({"bomb.zgl", packed_letters(kBomb, true, checksum)});
#endif
}

/// Files that say nothing, and files whose names say something else.
inline void add_misnamed(std::vector<HostileFile>& files) {
  const char* const extensions[] = {"glb", "gltf", "fbx", "dae", "stl", "obj", "ply",
                                    "bvh", "3ds",  "off", "x3d", "3mf", "nff", "blend"};
  for (const char* extension : extensions) files.push_back({std::string("empty.") + extension, ""});
  const std::string good = changed_glb({});
  for (const char* extension : {"fbx", "dae", "obj", "ply", "bvh", "txt", "json"})
    files.push_back({std::string("glb_named.") + extension, good});
  files.push_back({"zeros.fbx", std::string(1000000, '\0')});
  files.push_back({std::string(240, 'n') + ".glb", good.substr(0, 100)});

  // Good files that end too early.
  const std::string dae = collada(collada_mesh(kNineFloats, "9", "0 1 2"));
  for (const std::size_t part : {1, 2, 3}) {
    const std::string digit = std::to_string(part);
    files.push_back({"cut" + digit + ".glb", good.substr(0, good.size() * part / 4)});
    files.push_back({"cut" + digit + ".dae", dae.substr(0, dae.size() * part / 4)});
  }
  const std::string stl = std::string(80, ' ') + u32(2) + std::string(100, '\0');
  files.push_back({"cut.stl", stl.substr(0, 150)});
}

}  // namespace icloth
