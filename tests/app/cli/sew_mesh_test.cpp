// icloth sew MESH --within: panels that are delivered as a mesh.
#include <gtest/gtest.h>

#include "tests/app/cli/program.h"

namespace icloth::testing {
namespace {

namespace fs = std::filesystem;

TEST_F(Cli, PanelsOfAMeshAreSewnWhereTheirBordersMeet) {
  // Two sheets of 3 × 6 squares of 1 cm, 2 mm apart.
  std::string mesh;
  for (const double x : {0.0, 0.032})
    for (int j = 0; j <= 6; ++j)
      for (int i = 0; i <= 3; ++i)
        mesh += "v " + std::to_string(x + 0.01 * i) + " " + std::to_string(0.01 * j) + " 0\n";
  for (const int first : {1, 29})
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 3; ++i) {
        const int v = first + 4 * j + i;
        mesh += "f " + std::to_string(v) + " " + std::to_string(v + 1) + " " +
                std::to_string(v + 5) + " " + std::to_string(v + 4) + "\n";
      }
  write("panels.obj", mesh);

  // The welded garment has 7 vertices less, and says what was sewn.
  const Outcome sewn = icloth("sew panels.obj --within 4mm --report --out sewn.obj");
  EXPECT_EQ(sewn.code, 0) << sewn.err;
  EXPECT_TRUE(contains(sewn.out, "panel0:panel1")) << sewn.out;
  EXPECT_TRUE(contains(sewn.out, "2 panels, 1 seams; 14 of 36 border vertices")) << sewn.out;
  EXPECT_EQ(icloth("check sewn.obj").code, 0);
  std::ifstream file(folder_ / "sewn.obj");
  std::size_t vertices = 0;
  for (std::string line; std::getline(file, line);) vertices += line.starts_with("v ") ? 1 : 0;
  EXPECT_EQ(vertices, 49u);

  // The other form is a scene whose seam closes while it runs.
  EXPECT_EQ(icloth("sew panels.obj --within 0.4cm --out open.json").code, 0);
  const Outcome run = icloth("run open.json --steps 200");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "panel0:panel1")) << run.err;

  // What cannot be sewn is told in one line.
  expect_bad_input("sew panels.obj --within 1mm --quiet --out none.obj", "no borders within 1 mm");
  expect_bad_input("sew panels.obj --within 4 --out none.obj", "--within");
  expect_bad_input("sew panels.obj --rest panels.obj --out none.obj", "--within");

  // Panels are sewn where they lie: what is said about putting them on would do nothing.
  for (const char* option : {"--triangles 100", "--hold waist", "--settling 1", "--no-dress"})
    expect_bad_input(std::string("sew panels.obj --within 4mm --out none.obj ") + option,
                     "--within");
}

TEST_F(Cli, ADeliveredDressIsSewnOnItsBody) {
  const char* folder = std::getenv("ICLOTH_DATA");
  const std::string data = folder ? folder : ICLOTH_DATA_DEFAULT;
  if (!fs::exists(data + "/garments/dress_draped.obj"))
    GTEST_SKIP() << "no reference data in " << data;
  const Outcome sewn = icloth("sew '" + data + "/garments/dress_draped.obj' --rest '" + data +
                              "/garments/dress_rest.obj' --body '" + data +
                              "/bodies/rumba.obj' --within 4mm --report --out dress.obj");
  EXPECT_EQ(sewn.code, 0) << sewn.err;
  EXPECT_TRUE(contains(sewn.out, "14 panels, ")) << sewn.out;
  EXPECT_TRUE(contains(icloth("check dress.obj").out, "intersecting pairs 0"));
}

}  // namespace
}  // namespace icloth::testing
