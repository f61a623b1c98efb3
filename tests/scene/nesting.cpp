// Characters that parts place: where their instances are, in which order and material, and what cannot be nested.
#include "scene/nesting.h"

#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "scene/instances.h"
#include "scene/parse_scene.h"

using namespace kd;
using namespace kd::scene;

namespace {

/// A scene of two objects and these characters, each a line from the third on.
std::string scene_text(const std::vector<std::string>& characters) {
  std::string text = R"({"camera": {"position": [0, 0, 5], "target": [0, 0, 0]},
"objects": [{"name": "leaf", "file": "leaf.nkd"}, {"name": "stem", "file": "stem.nkd"}], "characters": [)";
  for (size_t i = 0; i < characters.size(); ++i) text += (i > 0 ? ",\n" : "\n") + characters[i];
  return text + "]}";
}

Scene scene_of(const std::vector<std::string>& characters) {
  const auto scene = parse_scene(scene_text(characters), "s");
  REQUIRE_MESSAGE(scene, (scene ? "" : scene.error().line()));
  return *scene;
}

std::string error_of(const std::vector<std::string>& characters) {
  const auto scene = parse_scene(scene_text(characters), "s");
  REQUIRE(!scene);
  CHECK(scene.error().error_class == ErrorClass::scene);
  return scene.error().line();
}

/// Objects that are the unit cube in model space.
const std::vector<Lattice> kUnitCubes(2, Lattice{{0, 0, 0}, {1, 1, 1}, 10});

std::vector<Instance> placed(const Scene& scene) {
  const auto instances = place_instances(scene, kUnitCubes);
  REQUIRE_MESSAGE(instances, (instances ? "" : instances.error().line()));
  return *instances;
}

Vec3d model_point(const Instance& instance, Vec3d p) { return instance.lattice_to_scene.apply_point(p * 1023.0); }

}  // namespace

TEST_CASE("nesting: frames compose, order is the file's, and what is not shown is seen only where it is placed") {
  const Scene scene = scene_of({
      R"({"name": "grove", "translate": [100, 0, 0], "parts": [)"
      R"({"character": "tree", "translate": [10, 0, 0], "scale": [2, 2, 2]},)"
      R"({"object": "stem"},)"
      R"({"character": "tree", "rotate": {"axis": [0, 0, 1], "degrees": 90}}]})",
      R"({"name": "tree", "shown": false, "scale": [1, 3, 1], "parts": [)"
      R"({"object": "stem"}, {"object": "leaf", "translate": [0, 1, 0]}]})",
      R"({"parts": [{"object": "leaf", "frame": {"point": [0, 0, 7], "x_axis": [1, 0, 0], "y_axis": [0, 1, 0], "z_axis": [0, 0, 1]}}]})",
  });
  CHECK(count_instances(scene).of_character == std::vector<uint32_t>{5, 2, 1});
  CHECK(count_instances(scene).shown == 6);
  const std::vector<Instance> instances = placed(scene);
  REQUIRE(instances.size() == 6);
  const uint32_t objects[] = {1, 0, 1, 1, 0, 0};
  const Vec3d origins[] = {{110, 0, 0}, {110, 6, 0}, {100, 0, 0}, {100, 0, 0}, {97, 0, 0}, {0, 0, 7}};
  const Vec3d far_corners[] = {{112, 6, 2}, {112, 12, 2}, {101, 1, 1}, {97, 1, 1}, {94, 1, 1}, {1, 1, 8}};
  for (size_t i = 0; i < instances.size(); ++i) {
    CAPTURE(i);
    CHECK(instances[i].object == objects[i]);
    CHECK(instances[i].material == kOwnMaterials);
    CHECK(length(model_point(instances[i], {0, 0, 0}) - origins[i]) < 1e-12);
    CHECK(length(model_point(instances[i], {1, 1, 1}) - far_corners[i]) < 1e-12);
  }
}

TEST_CASE("nesting: the outermost material wins") {
  const auto paint = [](int red) { return fmt::format(R"("material": {{"diffuse": [{}, 0, 0]}})", red); };
  const Scene scene = scene_of({
      fmt::format(R"({{"name": "a", "shown": false, "parts": [{{"object": "leaf", {}}}, {{"object": "stem"}}]}})",
                  paint(1)),
      fmt::format(R"({{"name": "b", "parts": [{{"character": "a"}}, {{"character": "a", {}}}]}})", paint(2)),
      fmt::format(R"({{"name": "c", "parts": [{{"character": "b", {}}}]}})", paint(3)),
  });
  const std::vector<Material> materials = override_materials(scene);
  std::vector<int> reds;
  for (const Instance& i : placed(scene)) {
    reds.push_back(i.material == kOwnMaterials ? 0 : static_cast<int>(materials[i.material].diffuse.x));
  }
  CHECK(reds == std::vector<int>{1, 0, 2, 2, 3, 3, 3, 3});
}

TEST_CASE("nesting: objects are used where something shown reaches them, with their own materials or not") {
  const std::string green = R"("material": {"diffuse": [0, 1, 0]})";
  const Scene scene = scene_of({
      R"({"name": "a", "shown": false, "parts": [{"object": "leaf"}]})",
      R"({"name": "b", "shown": false, "parts": [{"object": "stem"}]})",
      R"({"name": "c", "parts": [{"character": "a", )" + green + "}]}",
  });
  const std::vector<ObjectUse> uses = object_uses(scene);
  CHECK(uses[0].placed);
  CHECK_FALSE(uses[0].own_materials);
  CHECK_FALSE(uses[1].placed);
}

TEST_CASE("nesting: a character within itself, and what else cannot be, says where") {
  CHECK(error_of({R"({"name": "a", "parts": [{"object": "leaf"}, {"character": "a"}]})"}) ==
        "s:3:59: character 'a' is placed within itself");
  CHECK(error_of(
            {R"({"name": "a", "parts": [{"character": "b"}]})", R"({"name": "b", "parts": [{"character": "a"}]})"}) ==
        "s:4:39: character 'a' is placed within itself");
  CHECK(error_of({R"({"name": "a", "parts": [{"character": "c"}]})"}) ==
        "s:3:39: there is no character 'c' in the scene");
  CHECK(error_of({R"({"name": "a", "parts": [{"object": "leaf"}]})", R"({"name": "a", "parts": [{"object": "leaf"}]})",
                  R"({"parts": [{"character": "a"}]})"}) ==
        "s:5:26: there are several characters 'a': rename all but one");
  CHECK(error_of({R"({"name": "a", "parts": [{}]})"}) == "s:3:25: 'parts[0]' lacks 'object', or 'character'");
  CHECK(error_of({R"({"name": "a", "parts": [{"character": "b", "object": "leaf"}]})"}) ==
        "s:3:54: 'object' does not go with 'character': keep one of them");
  const std::string box = R"("box": {"point": [0,0,0], "x_axis": [1,0,0], "y_axis": [0,1,0], "z_axis": [0,0,1]})";
  CHECK(error_of(
            {R"({"parts": [{"character": "b", )" + box + "}]}", R"({"name": "b", "parts": [{"object": "leaf"}]})"}) ==
        "s:3:38: 'box' does not go with 'character': keep one of them");
  CHECK(error_of({"{" + box + R"(, "parts": [{"object": "leaf"}]})"}).starts_with("s:3:2: unknown field 'box'"));
  CHECK(error_of({R"({"shown": 0, "parts": [{"object": "leaf"}]})"}) ==
        "s:3:11: 'shown' must be true or false, not a number");
  CHECK(error_of({R"({"shown": "no", "parts": [{"object": "leaf"}]})"})
            .starts_with("s:3:11: 'shown' must be true or false"));
  CHECK(error_of({R"({"shown": falsey, "parts": [{"object": "leaf"}]})"}).starts_with("s:3:11: 'shown' must be true"));
}

TEST_CASE("nesting: 16 deep and no deeper, in any order") {
  const auto chain = [](int length, bool forward) {
    std::vector<std::string> characters;
    for (int i = 0; i < length; ++i) {
      const std::string placed = i + 1 < length ? fmt::format("\"character\": \"c{}\"", i + 1) : "\"object\": \"leaf\"";
      const std::string one = fmt::format(R"({{"name": "c{}", "shown": {}, "parts": [{{{}}}]}})", i, i == 0, placed);
      characters.insert(forward ? characters.end() : characters.begin(), one);
    }
    return characters;
  };
  for (const bool forward : {true, false}) {
    CHECK(placed(scene_of(chain(kMaxNesting, forward))).size() == 1);
    for (const int length : {kMaxNesting + 1, 1000}) {
      CHECK(error_of(chain(length, forward)).find("characters are nested more than 16 deep") != std::string::npos);
    }
  }
}

TEST_CASE("nesting: instances are counted before there are any") {
  // Each level places the one below it n times.
  const auto levels = [](const std::vector<int>& repeats) {
    std::vector<std::string> characters;
    for (size_t i = 0; i < repeats.size(); ++i) {
      const std::string one = i == 0 ? "{\"object\": \"leaf\"}" : fmt::format("{{\"character\": \"c{}\"}}", i - 1);
      std::string parts = one;
      for (int k = 1; k < repeats[i]; ++k) parts += ", " + one;
      characters.push_back(
          fmt::format(R"({{"name": "c{}", "shown": {}, "parts": [{}]}})", i, i + 1 == repeats.size(), parts));
    }
    return characters;
  };
  CHECK(count_instances(scene_of(levels({64, 64, 64, 16, 16}))).shown == kMaxInstances);
  CHECK(error_of(levels({64, 64, 64, 16, 17})) == "s:7:391: the scene has more than 67108864 instances: repeat less");
  CHECK(error_of(levels(std::vector<int>(16, 100))).find("more than 67108864 instances") != std::string::npos);
}

TEST_CASE("nesting: a singular placement is blamed on the one that is singular") {
  const auto error = [](const std::vector<std::string>& characters) {
    const auto instances = place_instances(scene_of(characters), kUnitCubes);
    REQUIRE_FALSE(instances);
    return instances.error().line();
  };
  const std::string flat = R"("frame": {"point": [0,0,0], "x_axis": [1,0,0], "y_axis": [1,0,0], "z_axis": [0,0,1]})";
  const std::string inner = R"({"name": "in", "shown": false, "parts": [{"name": "p", "object": "leaf"}]})";
  CHECK(error({inner, "{\"parts\": [{\"name\": \"q\", \"character\": \"in\", " + flat + "}]}"})
            .starts_with("s:4: part 'q': the placement is singular"));
  CHECK(error({inner, "{\"name\": \"out\", " + flat + ", \"parts\": [{\"character\": \"in\"}]}"})
            .starts_with("s:4: character 'out': the placement is singular"));
  CHECK(
      error(
          {inner,
           R"({"scale": [1e12, 1, 1], "parts": [{"character": "in", "rotate": {"axis": [0, 0, 1], "degrees": 45}, "scale": [1, 2, 1]}]})"})
          .starts_with("s:3: part 'p': the placement is singular together"));
  CHECK(error({inner, R"({"scale": [1e200, 1, 1], "parts": [{"character": "in", "scale": [1e200, 1, 1]}]})"})
            .starts_with("s:3: part 'p': "));
}
