// kdbench city and forest: a scene of a thousand million triangles in a few megabytes, with all that it is made of.
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "scene/write_scene.h"
#include "scenery/city.h"
#include "scenery/forest.h"
#include "table.h"

namespace kd::bench {

namespace {

namespace fs = std::filesystem;

using Make = scenery::Scenery (*)(uint64_t triangles, uint64_t seed, const std::string& folder);

struct Options {
  std::string folder;
  uint64_t triangles = 1'000'000'000;
  uint64_t seed = 1;
};

Result<void> make_folder(const fs::path& path) {
  std::error_code failure;
  fs::create_directories(path, failure);
  if (failure) return Error{ErrorClass::output, path.string(), "cannot make this folder: " + failure.message()};
  return {};
}

Result<void> write(const Options& o, const std::string& name, Make make) {
  tools::catch_interrupts();
  const fs::path folder(o.folder);
  for (const fs::path& needed : {folder / "meshes", folder / "compiled"}) {
    if (auto made = make_folder(needed); !made) return made;
  }
  const scenery::Scenery made = make(o.triangles, o.seed, o.folder);
  if (auto written = scenery::write_meshes((folder / "meshes").string(), name, made.meshes); !written) return written;
  const std::string file = (folder / (name + ".json")).string();
  if (auto written = scene::write_scene(made.scene, file); !written) return written;

  Table table({"mesh", "triangles"});
  for (const scenery::NamedMesh& m : made.meshes) table.add({m.name, fmt::format("{}", m.mesh.triangle_count())});
  fmt::print("{}\n{}: {} instances, {} triangles\n", table.markdown(), file, made.instances, made.triangles);
  return {};
}

Command scenery_command(CLI::App& app, const std::string& name, const std::string& description, Make make) {
  auto o = std::make_shared<Options>();
  CLI::App* c = app.add_subcommand(name, description);
  c->add_option("-o,--output", o->folder,
                "The folder for meshes/ and " + name + ".json; compile its meshes to compiled/ there")
      ->required()
      ->check(tools::file_name());
  c->add_option("--triangles", o->triangles, "Of all instances together, at least")
      ->check(tools::whole_number(scenery::kFewestTriangles, scenery::kMostTriangles))
      ->capture_default_str();
  c->add_option("--seed", o->seed, "Another seed, another " + name)
      ->check(tools::whole_number(0, 1'000'000'000))
      ->capture_default_str();
  return {c, [o, name, make] {
            const auto done = write(*o, name, make);
            return done ? 0 : tools::fail(kKdbench, done.error());
          }};
}

}  // namespace

Command city_command(CLI::App& app) {
  return scenery_command(app, "city", "Make a scene of any size: a city, its meshes and where they stand",
                         scenery::lay_out_city);
}

Command forest_command(CLI::App& app) {
  return scenery_command(app, "forest", "Make a scene of any size: a forest, its meshes and where they stand",
                         scenery::plant_forest);
}

}  // namespace kd::bench
