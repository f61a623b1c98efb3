// kdbench forest: a scene of a thousand million triangles in a few megabytes, with all that it is made of.
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "forest/forest.h"
#include "scene/write_scene.h"
#include "sys/atomic_file.h"
#include "table.h"

namespace kd::bench {

namespace {

namespace fs = std::filesystem;

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

Result<void> write_meshes(const fs::path& folder, const std::vector<forest::NamedMesh>& meshes) {
  const auto path = [&](std::string_view name) { return (folder / name).string(); };
  if (auto written = write_file(path(forest::kLibraryName), forest::library_text()); !written) return written;
  for (const forest::NamedMesh& m : meshes) {
    if (tools::interrupted()) return Error{ErrorClass::interrupted, folder.string(), "interrupted"};
    if (auto written = write_file(path(m.name + ".obj"), m.mesh.text(m.name)); !written) return written;
  }
  return {};
}

Result<void> make(const Options& o) {
  tools::catch_interrupts();
  const fs::path folder(o.folder);
  for (const fs::path& needed : {folder / "meshes", folder / "compiled"}) {
    if (auto made = make_folder(needed); !made) return made;
  }
  const forest::Forest forest = forest::plant_forest(o.triangles, o.seed, o.folder);
  if (auto written = write_meshes(folder / "meshes", forest.meshes); !written) return written;
  const std::string scene = (folder / "forest.json").string();
  if (auto written = scene::write_scene(forest.scene, scene); !written) return written;

  Table table({"mesh", "triangles"});
  for (const forest::NamedMesh& m : forest.meshes) table.add({m.name, fmt::format("{}", m.mesh.triangle_count())});
  fmt::print("{}\n{}: {} instances, {} triangles\n", table.markdown(), scene, forest.instances, forest.triangles);
  return {};
}

}  // namespace

Command forest_command(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* c = app.add_subcommand("forest", "Make a scene of any size: a forest, its meshes and where they stand");
  c->add_option("-o,--output", o->folder,
                "The folder for meshes/ and forest.json; compile its meshes to compiled/ there")
      ->required()
      ->check(tools::file_name());
  c->add_option("--triangles", o->triangles, "Of all instances together, at least")
      ->check(tools::whole_number(forest::kFewestTriangles, forest::kMostTriangles))
      ->capture_default_str();
  c->add_option("--seed", o->seed, "Another seed, another forest")
      ->check(tools::whole_number(0, 1'000'000'000))
      ->capture_default_str();
  return {c, [o] {
            const auto done = make(*o);
            return done ? 0 : tools::fail(kKdbench, done.error());
          }};
}

}  // namespace kd::bench
