// Every reader of the program, fed with bytes instead of files that people made. The fuzzer calls
// these functions with bytes of its own, the test with the files beside.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace icloth::fuzz {

/// Reads the bytes. Returns why they were refused, "" when they were accepted: InputError is the
/// one way to refuse them. Anything else that is thrown is an error of the program, above all
/// Broken.
using Read = std::string (*)(std::string_view bytes);

struct Target {
  std::string_view name;
  Read read;
};

std::span<const Target> targets();
/// Null for an unknown name.
const Target* find_target(std::string_view name);

std::string read_obj(std::string_view bytes);
std::string read_ply(std::string_view bytes);
std::string read_pc2(std::string_view bytes);
std::string read_mdd(std::string_view bytes);
std::string read_scene(std::string_view bytes);
std::string read_material(std::string_view bytes);
std::string read_recording(std::string_view bytes);
std::string read_camera(std::string_view bytes);
std::string read_pattern_json(std::string_view bytes);
std::string read_dxf(std::string_view bytes);
std::string read_body_answer(std::string_view bytes);
std::string read_query(std::string_view bytes);

}  // namespace icloth::fuzz
