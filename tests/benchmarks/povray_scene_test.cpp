// Scenes in POV-Ray's language: what its texts must say for the pictures to be of one scene.
#include "benchmarks/povray_scene.h"

#include <gtest/gtest.h>

#include "renderer/scene.h"
#include "tests/temporary_folder.h"

namespace raytree::benchmarks {
namespace {

std::string povray_text(const CheckerPattern& checker, const Matrix44d& transform) {
  SceneDescription description;
  description.cameras.emplace_back();
  MaterialDescription material;
  material.name = "checkered", material.diffuse = checker;
  description.materials = {material};
  ShapeDescription ball;
  ball.material = "checkered", ball.kind = SphereShape{}, ball.transform = transform;
  description.shapes = {ball};
  Warnings warnings;
  PrepareOptions options;
  options.build = false;
  const Scene scene = prepare(std::move(description), options, warnings);
  const test::TemporaryFolder folder;
  const std::string path = folder.path("scene.pov");
  write_povray_scene(path, scene, PovrayPicture::shaded);
  return test::file_text(path);
}

TEST(PovrayScene, ACheckerIsCarriedByTheTransformOfItsShape) {
  CheckerPattern checker;
  checker.size = 2;
  Matrix44d transform;
  transform.setTranslation(Vec3d(0.5, 0, -3));
  const std::string unmoved = "scale 2 translate <0,0,0> }", carried = "scale 2 translate <0,0,0> matrix <";
  EXPECT_TRUE(test::contains(povray_text(checker, transform), carried + "1,0,0,0,1,0,0,0,1,0.5,0,-3> }"));
  EXPECT_TRUE(test::contains(povray_text(checker, Matrix44d()), unmoved));
  checker.space = SolidSpace::world;
  EXPECT_TRUE(test::contains(povray_text(checker, transform), unmoved));
}

}  // namespace
}  // namespace raytree::benchmarks
