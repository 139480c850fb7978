#include "sim/scene/material_io.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "sim/files/assets.h"
#include "sim/files/error.h"
#include "sim/files/json_reader.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

/// Materials that name each other as their base end here.
constexpr int kMaxBases = 8;

/// A material on its way from its file.
struct Source {
  std::string folder;  ///< names of files are looked for here
  FileScope scope;
  int depth = 0;  ///< materials that are based on this one, each on the next
};

Material load(const std::string& name, const std::string& where, const Source& source);

template <std::size_t N>
void read_row(const JsonValue& value, double unit, std::array<double, N>& row) {
  const std::vector<double> numbers = value.numbers(N);
  for (std::size_t i = 0; i < N; ++i) row[i] = unit * numbers[i];
}

void read_stretching(const JsonValue& value, Material& material) {
  JsonObject object(value);
  const JsonValue rest = object.required("rest");
  read_row(rest, 1, material.stretching[0]);
  // c11 and c22 of cloth at rest: without them it has no stiffness at all.
  if (material.stretching[0][0] <= 0 || material.stretching[0][2] <= 0)
    rest.refuse("c11 and c22 above 0");
  for (std::size_t row = 1; row < 6; ++row) material.stretching[row] = material.stretching[0];
  if (object.has("stretched")) {
    const JsonValue stretched = object["stretched"];
    const std::vector<JsonValue> rows = stretched.items();
    if (rows.size() != 5) stretched.refuse("5 rows: along 0, 22.5, 45, 67.5 and 90 degrees");
    for (std::size_t row = 0; row < 5; ++row) read_row(rows[row], 1, material.stretching[row + 1]);
  }
  object.finish();
}

void read_bending(const JsonValue& value, double unit, Material& material) {
  const std::vector<JsonValue> rows = value.items();
  if (rows.size() != 3) value.refuse("3 rows: hinges along 0, 45 and 90 degrees");
  for (std::size_t row = 0; row < 3; ++row) {
    read_row(rows[row], unit, material.bending[row]);
    if (std::ranges::min(material.bending[row]) < 0) rows[row].refuse("numbers, at least 0");
  }
}

/// Tensile, shear and bending constants; throws where some strain would cost no energy.
void read_orthotropic(const JsonValue& value, Material& material) {
  JsonObject object(value);
  OrthotropicFabric f;

  // With a larger Poisson's ratio the tensile energy would not be positive for every strain.
  const std::vector<double> young = object.required("young").numbers(2, kPositive);
  f.young_u = young[0];
  f.young_v = young[1];
  f.poisson = object.number("poisson", 0, {-10, 10});
  const double most = kLargestCoupling * std::sqrt(f.young_u / f.young_v);
  if (!(std::fabs(f.poisson) < most))
    object["poisson"].refuse("|poisson| below 0.95 sqrt(E_u / E_v) = " + rounded_text(most, 6));
  f.shear = object.required("shear").number(kPositive);

  // The bending moduli follow from a thickness, as for a homogeneous sheet, unless they are given
  // themselves. One of the two must be there.
  if (object.has("thickness")) bend_as_sheet(f, object["thickness"].number({1e-6, 0.1}));
  if (object.has("bending")) {
    const JsonValue bending = object["bending"];
    const std::size_t count = bending.items().size();
    if (count != 2 && count != 3)
      bending.refuse("moduli along weft and warp in N m, and perhaps along the diagonal");
    const std::vector<double> moduli = bending.numbers(count, kNotNegative);
    f.bend_u = moduli[0];
    f.bend_v = moduli[1];
    f.bend_diagonal = count == 3 ? moduli[2] : -1;
    f.bending_poisson = 0;
  } else if (!object.has("thickness")) {
    object.required("bending");
  }
  object.finish();
  set_orthotropic(material, f);
}

void read_yarn_friction(const JsonValue& value, Material& material) {
  JsonObject object(value);
  material.bending_friction = object.number("bending", material.bending_friction, {0, 10});
  material.shear_friction = object.number("shear", material.shear_friction, {0, 1e6});
  object.finish();
}

/// With the orthotropic law the row at rest is all there is, and is used as it stands.
void check_orthotropic(const JsonValue& where, const Material& material) {
  const auto& row = material.stretching[0];
  if (material.law == Material::Law::orthotropic &&
      !(row[3] > 0 && coupling(row) < kLargestCoupling))
    where.refuse(
        "for the law \"orthotropic\" a row at rest with c33 above 0 and |c12| below "
        "0.95 sqrt(c11 c22)");
}

Material parse(const nlohmann::json& json, const std::string& where, const Source& source) {
  JsonObject object(JsonValue(json, where));
  Material material;

  // What a material does not say itself is that of its base.
  const bool has_base = object.has("base");
  if (has_base) {
    const JsonValue base = object["base"];
    if (source.depth >= kMaxBases) base.refuse("a material whose bases come to an end");
    material = load(base.text(), base.where(), {source.folder, source.scope, source.depth + 1});
  }

  // The texts are for readers, apart from the name and the law.
  material.name = object.text("name", material.name);
  object.text("description", "");
  object.text("source", "");
  if (object.has("law")) {
    const std::string& law = object["law"].text();
    if (law != "measured" && law != "orthotropic")
      object["law"].refuse("\"measured\" or \"orthotropic\"");
    material.law = law == "measured" ? Material::Law::measured : Material::Law::orthotropic;
  }

  // Density and damping, then the constants of an orthotropic fabric or the tables of a measured
  // one.
  if (object.has("density") || !has_base)
    material.density = object.required("density").number({1e-3, 100});
  material.damping = object.number("damping", material.damping, {0, 10});
  const bool constants = object.has("orthotropic");
  if (constants) {
    for (const char* key : {"law", "stretching", "bending", "bending_unit", "bending_spacing"})
      if (object.has(key)) object[key].refuse("no such key beside \"orthotropic\"");
    read_orthotropic(object["orthotropic"], material);
  }

  // Tables stand in the place of constants, and a fabric without either has those of its base.
  if (object.has("stretching") || !(has_base || constants))
    read_stretching(object.required("stretching"), material);
  const double unit = object.number("bending_unit", 1, kPositive);
  if (object.has("bending") || !(has_base || constants)) {
    read_bending(object.required("bending"), unit, material);
    material.bending_spacing = Material{}.bending_spacing;  // not that of the base's samples
  }

  // The rest may be said in addition to any of these.
  material.bending_spacing = object.number("bending_spacing", material.bending_spacing, {0.1, 1e4});
  material.bending_poisson =
      object.number("bending_poisson", material.bending_poisson, {-0.95, 0.95});
  if (object.has("yarn_friction")) read_yarn_friction(object["yarn_friction"], material);
  material.strain_limit = object.number("strain_limit", material.strain_limit, {0, 10});
  check_orthotropic(object.value(), material);
  object.finish();
  return material;
}

std::string material_path(const std::string& name, const std::string& folder) {
  if (std::filesystem::path(name).extension() == ".json") return find_asset(name, folder);
  const std::string path = assets_folder() + "/materials/" + name + ".json";
  std::error_code error;
  if (name.find('/') != std::string::npos || !std::filesystem::exists(path, error))
    throw InputError("material " + in_quotes(name) +
                     " is not known, expected a .json file or one of:" + asset_names("materials"));
  return path;
}

Material load(const std::string& name, const std::string& where, const Source& source) {
  const std::string path = material_path(name, source.folder);
  require_in_scope(path, name, where, source.scope);
  return parse(read_json(path), shown_path(path),
               {std::filesystem::path(path).parent_path(), source.scope, source.depth});
}

}  // namespace

Material parse_material(const nlohmann::json& json, const std::string& where,
                        const FileScope& scope) {
  return parse(json, where, {scope.folder, scope});
}

Material load_material(const std::string& name, const std::string& where, const FileScope& scope) {
  return load(name, where, {scope.folder, scope});
}

Material load_material(const std::string& name, const std::string& folder) {
  const std::string path = material_path(name, folder);
  const std::string own = std::filesystem::path(path).parent_path();
  return parse(read_json(path), shown_path(path), {own, {own}});
}

}  // namespace icloth
