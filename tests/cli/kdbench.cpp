// kdbench trace, from outside.
#include <array>
#include <cstring>
#include <filesystem>

#include <doctest/doctest.h>

#include "cli/json_schema.h"
#include "cli/run_tool.h"

using namespace kd;
using namespace kd::test;

namespace {

constexpr const char* kTool = "kdbench";

const std::string kCamera = "# eye, target, up, fov, light\n0 0 3  0 0 0  0 1 0\n45  2 2 2\n";

using Ray = std::array<float, 8>;  // origin, t_min, direction, t_max

struct Hit {
  float t;
  int32_t primitive;
  float u, v;
};

std::string ray_file(std::initializer_list<Ray> rays) {
  std::string bytes;
  for (const Ray& ray : rays) bytes.append(reinterpret_cast<const char*>(ray.data()), sizeof ray);
  return bytes;
}

std::vector<Hit> hits_of(const std::string& bytes) {
  REQUIRE(bytes.size() % sizeof(Hit) == 0);
  std::vector<Hit> hits(bytes.size() / sizeof(Hit));
  std::memcpy(hits.data(), bytes.data(), bytes.size());
  return hits;
}

void check_miss(const Hit& hit, float t_max) {
  CHECK(hit.primitive == -1);
  CHECK(hit.t == t_max);
  CHECK(hit.u == 0);
  CHECK(hit.v == 0);
}

}  // namespace

TEST_SUITE("kdbench trace") {
  TEST_CASE("--camera makes and traces the shared rays") {
    Terminal t;
    t.compile_data("icosphere.ply");
    t.write("cam.txt", kCamera);
    const Arguments arguments{"trace",     "compiled/icosphere.nkd",
                              "--camera",  "cam.txt",
                              "--size",    "64x48",
                              "--repeat",  "2",
                              "--warm-up", "0",
                              "--json",    "r.json",
                              "--hits",    "h.bin",
                              "--device",  "cpu"};
    const std::string text = t.succeeds(kTool, arguments).out;
    const auto report = nlohmann::json::parse(t.read("r.json"));
    check_report("kdbench-trace", report);
    CHECK(report["triangles"] == 1280);
    CHECK(report["repeats"] == 2);
    REQUIRE(report["results"].size() == 3);
    size_t rays = 0;
    const char* classes[] = {"primary", "shadow", "diffuse"};
    for (size_t i = 0; i < 3; ++i) {
      const auto& result = report["results"][i];
      CHECK(result["class"] == classes[i]);
      CHECK(text.find(result["ray_hash"].get<std::string>()) != std::string::npos);
      rays += result["rays"].get<size_t>();
    }
    const auto& primary = report["results"][0];
    CHECK(primary["rays"] == 64 * 48);
    // Seen from 3 radii away the sphere is a disc of tangent 1/sqrt(8), in a view 8/3 tan(22.5)^2 x 2 wide and high.
    CHECK(primary["hits"].get<double>() / (64 * 48) == doctest::Approx(0.424).epsilon(0.02));
    CHECK(report["results"][1]["rays"] == primary["hits"]);
    CHECK(hits_of(t.read("h.bin")).size() == rays);

    const std::string hits = t.read("h.bin");
    Arguments again = arguments;
    again.insert(again.end(), {"--threads", "1", "--count"});
    t.succeeds(kTool, again);
    CHECK(t.read("h.bin") == hits);
    const auto counted = nlohmann::json::parse(t.read("r.json"));
    check_report("kdbench-trace", counted);
    CHECK(counted["results"][0]["ray_hash"] == primary["ray_hash"]);
    CHECK(counted["results"][0]["steps_per_ray"]["nodes"] > 0);
  }

  TEST_CASE("rays of a file, with known answers") {
    Terminal t;
    t.compile_data("quad.obj");
    // Triangle 0 is (-.5,0,.5) (.5,0,.5) (.5,0,-.5); p = a + u (b - a) + v (c - a).
    t.write("rays.bin", ray_file({{0.25f, 2, 0, 0, 0, -1, 0, 1e30f},    // the point u = 1/4, v = 1/2
                                  {3, 2, 0, 0, 0, -1, 0, 100},          // beside it
                                  {-0.25f, -3, 0, 0, 0, 2, 0, 1e30f},   // triangle 1, from below, direction of length 2
                                  {0.25f, 2, 0, 0, 0, -1, 0, 1.5f}}));  // ends above it
    const auto trace = [&](const char* mode) {
      const auto report = t.report(kTool, {"trace", "compiled/quad.nkd", "rays.bin", "--mode", mode, "--json", "-",
                                           "--hits", "h.bin", "--repeat", "1", "--device", "cpu"});
      check_report("kdbench-trace", report);
      CHECK(report["results"][0]["class"] == "file");
      CHECK(report["results"][0]["mode"] == mode);
      CHECK(report["results"][0]["hits"] == 2);
      CHECK(report["results"][0]["mean_t"].get<double>() == doctest::Approx(1.75).epsilon(1e-6));
      return hits_of(t.read("h.bin"));
    };
    const auto hits = trace("closest");
    REQUIRE(hits.size() == 4);
    CHECK(hits[0].t == doctest::Approx(2).epsilon(1e-6));
    CHECK(hits[0].primitive == 0);
    CHECK(hits[0].u == doctest::Approx(0.25).epsilon(1e-5));
    CHECK(hits[0].v == doctest::Approx(0.5).epsilon(1e-5));
    check_miss(hits[1], 100);
    CHECK(hits[2].t == doctest::Approx(1.5).epsilon(1e-6));
    CHECK(hits[2].primitive == 1);
    check_miss(hits[3], 1.5f);

    const auto any = trace("any");
    REQUIRE(any.size() == 4);
    CHECK(any[0].primitive == 0);
    check_miss(any[1], 100);
    CHECK(any[2].primitive == 1);
    check_miss(any[3], 1.5f);
  }

  TEST_CASE("--triangle-test, on either form of vertices") {
    Terminal t;
    const std::string mesh = data_file("icosphere.ply");
    t.succeeds("kdbuild", {"build", mesh, "-o", "lattice.nkd"});
    t.succeeds("kdbuild", {"build", mesh, "-o", "float32.nkd", "--vertices", "float32"});
    t.write("cam.txt", kCamera);
    const auto trace = [&](const std::string& form, const Arguments& more) {
      Arguments all{"trace",  form + ".nkd", "--camera", "cam.txt", "--size", "64x48",    "--repeat", "1",
                    "--json", "r.json",      "--count",  "--hits",  "h.bin",  "--device", "cpu"};
      all.insert(all.end(), more.begin(), more.end());
      const std::string text = t.succeeds(kTool, all).out;
      auto report = nlohmann::json::parse(t.read("r.json"));
      check_report("kdbench-trace", report);
      CHECK(report["vertex_form"] == form);
      const std::string said = "vertices: " + form + ", triangle test: " + report["triangle_test"].get<std::string>();
      CHECK_MESSAGE(text.find(said) != std::string::npos, text);
      return report;
    };
    const auto exact = trace("lattice", {});
    CHECK(exact["triangle_test"] == "exact");
    CHECK(trace("float32", {})["triangle_test"] == "woop");
    const auto expected = hits_of((trace("lattice", {"--triangle-test", "exact"}), t.read("h.bin")));
    for (const char* form : {"lattice", "float32"}) {
      for (const char* test : {"moller-trumbore", "woop"}) {
        const auto report = trace(form, {"--triangle-test", test});
        CHECK(report["triangle_test"] == test);
        CHECK(report["results"][0]["ray_hash"] == exact["results"][0]["ray_hash"]);
        CHECK(report["results"][0]["hits"].get<double>() ==
              doctest::Approx(exact["results"][0]["hits"].get<double>()).epsilon(0.01));
        CHECK(report["results"][0]["mean_t"].get<double>() ==
              doctest::Approx(exact["results"][0]["mean_t"].get<double>()).epsilon(1e-3));
        const auto hits = hits_of(t.read("h.bin"));
        int same = 0, differ = 0;
        for (size_t i = 0; i < 64 * 48; ++i) {
          ++(hits[i].primitive == expected[i].primitive ? same : differ);
          if (hits[i].primitive != expected[i].primitive || hits[i].primitive < 0) continue;
          CHECK(hits[i].t == doctest::Approx(expected[i].t).epsilon(1e-4));
        }
        CHECK(differ < same / 50);
      }
    }
    t.fails(kTool, {"trace", "float32.nkd", "--camera", "cam.txt", "--triangle-test", "exact"}, ErrorClass::usage,
            {"--triangle-test exact", "float32.nkd", "without --vertices float32"});
    t.fails(kTool, {"trace", "lattice.nkd", "--camera", "cam.txt", "--triangle-test", "plucker"}, ErrorClass::usage,
            {"--triangle-test plucker", "moller-trumbore", "woop"});
  }

  TEST_CASE("primitives are numbered as in the source") {
    const Terminal t;
    t.write("q.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2\nf 1 2 3\n");
    t.succeeds("kdbuild", {"build", "q.obj", "-o", "q.nkd"});
    t.write("rays.bin", ray_file({{0.25f, 0.25f, 1, 0, 0, 0, -1, 10}}));
    t.succeeds(kTool, {"trace", "q.nkd", "rays.bin", "--hits", "h.bin", "--repeat", "1"});
    CHECK(hits_of(t.read("h.bin"))[0].primitive == 1);
  }

  TEST_CASE("an empty file of rays") {
    Terminal t;
    t.compile_data("quad.obj");
    t.write("none.bin", "");
    const auto report =
        t.report(kTool, {"trace", "compiled/quad.nkd", "none.bin", "--json", "-", "--hits", "h.bin", "--repeat", "1"});
    check_report("kdbench-trace", report);
    CHECK(report["results"][0]["rays"] == 0);
    CHECK(t.read("h.bin") == "");
  }

  TEST_CASE("errors") {
    Terminal t;
    t.compile_data("quad.obj");
    const std::string quad = "compiled/quad.nkd";
    t.write("rays.bin", ray_file({{0.25f, 2, 0, 0, 0, -1, 0, 1e30f}}));
    t.write("cam.txt", kCamera);
    const auto fails = [&](Arguments arguments, ErrorClass error_class, const std::vector<std::string>& fragments) {
      arguments.insert(arguments.begin(), "trace");
      t.fails(kTool, arguments, error_class, fragments);
    };
    t.fails(kTool, {}, ErrorClass::usage, {"subcommand"});
    fails({}, ErrorClass::usage, {"object"});
    fails({quad}, ErrorClass::usage, {"--camera"});
    fails({quad, "rays.bin", "--camera", "cam.txt"}, ErrorClass::usage, {"--camera"});
    for (const char* size : {"64", "64x", "x48", "0x48", "64x48x2", "-1x5", "99999x2", "64x48 "}) {
      fails({quad, "--camera", "cam.txt", "--size", size}, ErrorClass::usage, {"--size", size});
    }
    t.write("odd.bin", std::string(33, '\0'));
    fails({quad, "odd.bin", "--hits", "h.bin"}, ErrorClass::usage, {"odd.bin", "33", "32"});
    fails({quad, "gone.bin"}, ErrorClass::missing, {"gone.bin"});
    fails({quad, "--camera", "gone.txt"}, ErrorClass::missing, {"gone.txt"});
    fails({"gone.nkd", "rays.bin"}, ErrorClass::missing, {"gone.nkd"});
    fails({"rays.bin", "rays.bin"}, ErrorClass::object, {"rays.bin", "NKD101"});
    fails({quad, "rays.bin", "--mode", "some"}, ErrorClass::usage, {"--mode", "some"});
    fails({quad, "rays.bin", "--repeat", "0"}, ErrorClass::usage, {"--repeat"});
    fails({quad, "rays.bin", "--device", "nonsense"}, ErrorClass::usage, {"--device nonsense"});
    fails({quad, "rays.bin", "--device", "cuda:99"}, ErrorClass::device, {"--device cuda:99"});
    fails({quad, "rays.bin", "--repeat", "1", "--hits", "gone/h.bin"}, ErrorClass::output, {"gone/h.bin"});
    t.write("short.txt", "0 0 3  0 0 0  0 1 0  45  2 2\n");
    fails({quad, "--camera", "short.txt"}, ErrorClass::usage, {"short.txt", "13", "12"});
  }

  TEST_CASE("a size beyond 32 bits does not wrap around") {
    Terminal t;
    t.compile_data("quad.obj");
    t.write("cam.txt", kCamera);
    t.fails(kTool, {"trace", "compiled/quad.nkd", "--camera", "cam.txt", "--size", "4294967297x1", "--repeat", "1"},
            ErrorClass::usage, {"--size"});
  }

  TEST_CASE("a camera that shows nothing is an error") {
    Terminal t;
    t.compile_data("quad.obj");
    for (const char* camera : {"0 0 0  0 0 0  0 1 0  45  2 2 2", "0 0 3  nan 0 0  0 1 0  45  2 2 2",
                               "0 0 3  0 0 0  0 0 1  45  2 2 2", "0 0 3  0 0 0  0 1 0  200  2 2 2"}) {
      t.write("cam.txt", camera);
      t.fails(kTool, {"trace", "compiled/quad.nkd", "--camera", "cam.txt", "--size", "8x8", "--repeat", "1"},
              ErrorClass::usage, {"cam.txt"});
    }
  }

  TEST_CASE("a report that cannot be written leaves no hits") {
    Terminal t;
    t.compile_data("quad.obj");
    t.write("rays.bin", ray_file({{0.25f, 2, 0, 0, 0, -1, 0, 1e30f}}));
    t.fails(kTool,
            {"trace", "compiled/quad.nkd", "rays.bin", "--repeat", "1", "--hits", "h.bin", "--json", "gone/r.json"},
            ErrorClass::output, {"gone/r.json"});
  }

  TEST_CASE("--help tells of every option") {
    const Terminal t;
    const std::string help = t.succeeds(kTool, {"trace", "--help"}).out;
    for (const char* option : {"--camera", "--size", "--mode", "--device", "--threads", "--repeat", "--warm-up",
                               "--count", "--triangle-test", "--hits", "--json", "rays"}) {
      CHECK_MESSAGE(help.find(option) != std::string::npos, option);
    }
  }
}
