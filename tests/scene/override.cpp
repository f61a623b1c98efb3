// Values of a scene changed by path.
#include "scene/override.h"

#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "scene/parse_scene.h"

using namespace kd;
using namespace kd::scene;

namespace {

const std::string kScene = R"({
  "camera": {"position": [0, 0, 5], "target": [0, 0, 0]},
  "lights": [{"kind": "point", "position": [1, 1, 1], "colour": [1, 1, 1]}],
  "objects": [{"name": "a", "file": "a.nkd"}],
  "characters": [{ "parts": [{"object": "a"}]}, {"parts": [{"object": "a", "translate": [1, 0, 0]}]}]
})";

Result<Scene> changed(const std::vector<std::string>& texts) {
  std::vector<Override> overrides;
  for (const std::string& text : texts) {
    const auto change = parse_override(text);
    if (!change) return change.error();
    overrides.push_back(*change);
  }
  return parse_scene(kScene, "s", overrides);
}

std::string error_of(const std::vector<std::string>& texts) {
  const auto scene = changed(texts);
  REQUIRE(!scene);
  CHECK(scene.error().error_class == ErrorClass::usage);
  return scene.error().line();
}

const TransformPlacement& transform(const Scene& scene, size_t character) {
  return std::get<TransformPlacement>(scene.characters[character].parts[0].placement);
}

}  // namespace

TEST_CASE("override: values that are there are replaced, others added, objects around them too") {
  const auto scene = changed({"camera.vertical_fov=35", "camera.position=[0, 1, 9]", "lights[0].colour=[1,0,0]",
                              "characters[1].parts[0].translate=[0,1,0]", "film.width=640", "film.height=320",
                              "characters[0].parts[0].material.diffuse=[0, 0, 1]", "characters[0].name=\"b = c\"",
                              "camera.target[1]=0.5", "camera.keys=[{\"frame\": 3, \"vertical_fov\": 20}]",
                              "camera.keys[0].frame=7", "characters[1].shown=false"});
  REQUIRE_MESSAGE(scene, (scene ? "" : scene.error().line()));
  CHECK(scene->camera.vertical_fov_degrees == 35);
  CHECK(scene->camera.position == Vec3d{0, 1, 9});
  CHECK(scene->camera.target == Vec3d{0, 0.5, 0});
  CHECK(scene->camera.keys.at(0).frame == 7);
  CHECK(scene->lights[0].colour == Vec3f{1, 0, 0});
  CHECK(transform(*scene, 1).translate == Vec3d{0, 1, 0});
  CHECK(scene->film.width == 640);
  CHECK(scene->film.height == 320);
  CHECK(scene->characters[0].parts[0].material->diffuse == Vec3f{0, 0, 1});
  CHECK(scene->characters[0].name == "b = c");
  CHECK_FALSE(scene->characters[1].shown);
  CHECK(scene->characters[1].parts[0].line == 5);
}

TEST_CASE("override: the last of several for one value holds, and an empty object is filled") {
  const auto scene = changed({"film={}", "film.width=10", "film.width=20", "lights=[]"});
  REQUIRE(scene);
  CHECK(scene->film.width == 20);
  CHECK(scene->lights.empty());
}

TEST_CASE("override: what cannot be names the override and says what there is") {
  CHECK(
      error_of({"camera.fov=35"}) ==
      "camera.fov=35: unknown field 'fov': 'camera' may have interpolation, keys, position, target, up, vertical_fov");
  CHECK(error_of({"cam.fov=35"}).starts_with("cam.fov=35: unknown field 'cam': the scene may have "));
  CHECK(error_of({"lights[1].colour=[1, 0, 0]"}) == "lights[1].colour=[1, 0, 0]: there is no element 1 in 'lights'");
  CHECK(error_of({"camera.keys[0].frame=3"}) == "camera.keys[0].frame=3: there is no element 0 in 'camera.keys'");
  CHECK(error_of({"camera.position[3]=3"}) == "camera.position[3]=3: there is no element 3 in 'camera.position'");
  CHECK(error_of({"camera.up[0]=3"}) == "camera.up[0]=3: there is no element 0 in 'camera.up'");
  CHECK(error_of({"camera[0]=3"}) == "camera[0]=3: 'camera' is no array");
  CHECK(error_of({"lights.colour=3"}) == "lights.colour=3: 'lights' has no fields");
  CHECK(error_of({"camera.position.x=3"}) == "camera.position.x=3: 'camera.position' has no fields");
  CHECK(error_of({"lights[-1]={}"}) == "lights[-1]={}: an index must be a whole number from 0 on, not '-1'");
  CHECK(error_of({"lights[0=1"}) == "lights[0=1: the path has '[' without ']'");
  CHECK(error_of({"lights[0]colour=1"}) == "lights[0]colour=1: the path must go on with '.' or '[' behind 'lights[0]'");
  CHECK(error_of({"camera.=1"}).starts_with("camera.=1: unknown field ''"));
  CHECK(error_of({".camera=1"}).starts_with(".camera=1: unknown field ''"));
  CHECK(error_of({"film.width=wide"}) ==
        "film.width=wide: the value must be a whole number from 0 to 4294967295, not 'wide'");
  CHECK(error_of({"camera.vertical_fov=35 36"}) == "camera.vertical_fov=35 36: a number after the end of the value");
  CHECK(error_of({"camera.up=[1, 2]"}) == "camera.up=[1, 2]: the value must be an array of 3 numbers, not of 2");
  CHECK(error_of({"characters[0].name=b"}) == "characters[0].name=b: the value must be a string, not 'b'");
  CHECK(error_of({"camera.vertical_fov=35}"}).find("after the end of the value") != std::string::npos);
  CHECK(error_of({"camera.vertical_fov"}).ends_with("an override is written path=value, as in film.width=640"));
  CHECK(error_of({"=35"}).ends_with("an override is written path=value, as in film.width=640"));
  CHECK(error_of({"camera.up="}).ends_with("an override is written path=value, as in film.width=640"));
}

TEST_CASE("override: one that leaves no scene is to blame, the first of them") {
  CHECK(error_of({"film.width=0"}) == "film.width=0: the film's width must be from 1 to 65536 pixels");
  CHECK(error_of({"film.width=10", "characters[0].parts[0].object=\"b\"", "film.height=10"}) ==
        "characters[0].parts[0].object=\"b\": there is no object 'b': the scene has a");
  // Together they are right, each alone is not.
  const auto sun = changed({"lights[0].kind=\"directional\"",
                            "lights[0]={\"kind\": \"directional\", \"direction\": [0, 0, 1], "
                            "\"colour\": [1, 1, 1]}"});
  CHECK(sun);
  // The scene's own faults are its own.
  const std::vector<Override> wide{{"film.width", "10"}};
  const auto bad = parse_scene("{\"camera\": 1}", "s", wide);
  REQUIRE(!bad);
  CHECK(bad.error().line().starts_with("s:1:12: 'camera' must be an object"));
  CHECK(read_scene("/nonexistent", wide).error().error_class == ErrorClass::missing);
}
