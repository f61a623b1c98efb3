// kdbuild info and validate, from outside: sound objects, and every way of being none.
#include <algorithm>
#include <cstring>
#include <span>

#include <doctest/doctest.h>
#include <sys/stat.h>

#include "cli/run_tool.h"
#include "nkd/object_file.h"

using namespace kd;
using namespace kd::test;

namespace {

constexpr const char* kTool = "kdbuild";

/// An object with every section: normals, materials, and a dropped triangle (so source primitives).
void write_full_object(const Terminal& t) {
  t.write("full.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
  t.write("full.obj",
          "mtllib full.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nvn 0 1 0\n"
          "usemtl red\nf 1//1 1//1 2//1\nf 1//1 3//1 2//1\nf 1//2 2//2 4//2\nusemtl blue\nf 1//1 4//1 3//2\n"
          "f 2//1 3//1 4//1\n");
  t.succeeds(kTool, {"build", "full.obj", "-o", "full.nkd"});
}

template <class T>
std::string bytes_of(std::span<const T> section) {
  return {reinterpret_cast<const char*>(section.data()), section.size_bytes()};
}

std::string flipped(std::string bytes, size_t at) {
  bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
  return bytes;
}

}  // namespace

TEST_SUITE("kdbuild info and validate") {
  TEST_CASE("a sound object") {
    const Terminal t;
    write_full_object(t);
    const std::string text = t.succeeds(kTool, {"info", "full.nkd"}).out;
    for (const char* part : {"full.nkd: 4 triangles", "made from full.obj", "21 bits an axis", "red, blue"}) {
      CHECK_MESSAGE(text.find(part) != std::string::npos, part << "\n" << text);
    }
    const auto info = t.report(kTool, {"info", "full.nkd", "--format", "json"});
    CHECK(info["version"] == 1);
    CHECK(info["triangles"] == 4);
    CHECK(info["vertices"] == 4);
    CHECK(info["bytes"] == t.read("full.nkd").size());
    CHECK(t.succeeds(kTool, {"validate", "full.nkd"}).out == "full.nkd: sound\n");
    const auto verdict = t.report(kTool, {"validate", "full.nkd", "--format", "json"});
    CHECK(verdict["files"][0]["sound"] == true);
    t.fails(kTool, {"info", "full.nkd", "--format", "xml"}, ErrorClass::usage, {"--format", "xml"});
    t.fails(kTool, {"info"}, ErrorClass::usage, {"file"});
    t.fails(kTool, {"validate"}, ErrorClass::usage, {"files"});
  }

  TEST_CASE("what is no object") {
    const Terminal t;
    write_full_object(t);
    const std::string good = t.read("full.nkd");
    const auto both_fail = [&](const std::string& name, ErrorClass error_class, const std::string& fragment) {
      t.fails(kTool, {"info", name}, error_class, {name, fragment});
      t.fails(kTool, {"validate", name}, error_class, {name, fragment});
    };
    both_fail("gone.nkd", ErrorClass::missing, "No such file");
    for (const size_t length :
         {size_t{0}, size_t{1}, size_t{7}, size_t{8}, size_t{40}, good.size() / 2, good.size() - 64}) {
      CAPTURE(length);
      t.write("bad.nkd", good.substr(0, length));
      both_fail("bad.nkd", ErrorClass::object, "NKD10");
    }
    t.write("bad.nkd", "This is a text, and no object at all.\n");
    both_fail("bad.nkd", ErrorClass::object, "NKD101");
    t.write("bad.nkd", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x8\2\0\0\0", 29));
    both_fail("bad.nkd", ErrorClass::object, "NKD101");
  }

  TEST_CASE("a pipe with nobody at the other end is refused, not waited for") {
    const Terminal t;
    REQUIRE(mkfifo(t.path("pipe.nkd").c_str(), 0600) == 0);
    Conditions conditions;
    conditions.patience = std::chrono::seconds(1);
    t.fails(kTool, {"info", "pipe.nkd"}, ErrorClass::missing, {"pipe.nkd"}, conditions);
  }

  TEST_CASE("a byte too few or too many at the end") {
    const Terminal t;
    write_full_object(t);
    const std::string good = t.read("full.nkd");
    t.write("short.nkd", good.substr(0, good.size() - 1));  // of the padding behind the last section
    t.fails(kTool, {"validate", "short.nkd"}, ErrorClass::object, {"short.nkd"});
    t.write("long.nkd", good + "x");
    t.fails(kTool, {"validate", "long.nkd"}, ErrorClass::object, {"long.nkd"});
  }

  TEST_CASE("one flipped byte in any section") {
    const Terminal t;
    write_full_object(t);
    const std::string good = t.read("full.nkd");
    const auto file = nkd::ObjectFile::open(t.path("full.nkd"));
    REQUIRE(file);
    const auto& g = file->geometry();
    const auto normals = file->normals();
    const auto materials = file->materials();
    const auto sources = file->source_primitives();
    REQUIRE((normals && materials && sources));
    const std::pair<const char*, std::string> sections[] = {{"nodes", bytes_of<Node>(g.nodes)},
                                                            {"references", bytes_of<uint32_t>(g.references)},
                                                            {"triangles", bytes_of<uint8_t>(g.triangles)},
                                                            {"vertices", bytes_of<uint8_t>(g.vertices)},
                                                            {"source_primitives", bytes_of<uint32_t>(*sources)},
                                                            {"normals", bytes_of<Vec3f>(normals->values)},
                                                            {"normal_indices", bytes_of<uint32_t>(normals->indices)},
                                                            {"materials", bytes_of<Material>(materials->values)},
                                                            {"material_ids", bytes_of<uint16_t>(materials->ids)}};
    for (const auto& [name, bytes] : sections) {
      CAPTURE(name);
      REQUIRE(bytes.size() > 0);
      const size_t start = good.rfind(bytes);
      REQUIRE(start != std::string::npos);
      for (const size_t at : {size_t{0}, bytes.size() / 2, bytes.size() - 1}) {
        t.write("bad.nkd", flipped(good, start + at));
        const ToolRun run = t.run(kTool, {"validate", "bad.nkd"});
        CHECK(run.status == 5);
        CHECK(run.out == "");
        CHECK(run.err.starts_with("kdbuild: error: bad.nkd: NKD"));
        CHECK_MESSAGE(run.err.find(name) != std::string::npos, run.err);
      }
    }
  }

  TEST_CASE("no flipped byte crashes it") {
    const Terminal t;
    write_full_object(t);
    const std::string good = t.read("full.nkd");
    for (size_t at = 0; at < good.size(); at += 11) {
      CAPTURE(at);
      t.write("bad.nkd", flipped(good, at));
      const int status = t.run(kTool, {"validate", "bad.nkd"}).status;
      CHECK((status == 0 || status == 5));
    }
  }

  TEST_CASE("a flipped bit in the box is found") {
    const Terminal t;
    t.succeeds(kTool, {"build", data_file("quad.obj"), "-o", "q.nkd"});
    const double extent[3] = {1, 0, 1};
    std::string object = t.read("q.nkd");
    const size_t at = object.find(std::string(reinterpret_cast<const char*>(extent), sizeof extent));
    REQUIRE(at != std::string::npos);
    object[at + 5] = static_cast<char>(object[at + 5] ^ 1);  // 1.0 -> 1.0002
    t.write("q.nkd", object);
    CHECK(t.run(kTool, {"validate", "q.nkd"}).status == 5);
  }

  TEST_CASE("a version of the future") {
    const Terminal t;
    t.succeeds(kTool, {"build", data_file("quad.obj"), "-o", "q.nkd"});
    std::string object = t.read("q.nkd");
    // The FlatBuffer's root table, and in it the field that its vtable names first: version.
    const auto load = [&](size_t at, auto value) { return std::memcpy(&value, &object[at], sizeof value), value; };
    const size_t root = load(0, uint32_t{});
    const size_t vtable = root - static_cast<size_t>(load(root, int32_t{}));
    const size_t version = root + load(vtable + 4, uint16_t{});
    REQUIRE(load(version, uint32_t{}) == nkd::kFormatVersion);
    object[version] = static_cast<char>(nkd::kFormatVersion + 1);
    t.write("q.nkd", object);
    t.fails(kTool, {"info", "q.nkd"}, ErrorClass::object, {"q.nkd", "NKD102", "version"});
    t.fails(kTool, {"validate", "q.nkd"}, ErrorClass::object, {"q.nkd", "NKD102"});
  }

  TEST_CASE("validate reports on all files") {
    const Terminal t;
    write_full_object(t);
    const std::string good = t.read("full.nkd");
    t.write("cut.nkd", good.substr(0, 300));
    t.write("last.nkd", good);
    const ToolRun text = t.run(kTool, {"validate", "full.nkd", "cut.nkd", "gone.nkd", "last.nkd"});
    CHECK(text.status == 5);
    CHECK(text.out == "full.nkd: sound\nlast.nkd: sound\n");
    CHECK(std::count(text.err.begin(), text.err.end(), '\n') == 2);
    CHECK(text.err.starts_with("kdbuild: error: cut.nkd: NKD10"));
    CHECK(text.err.find("\nkdbuild: error: gone.nkd: ") != std::string::npos);
    const ToolRun run = t.run(kTool, {"validate", "full.nkd", "cut.nkd", "last.nkd", "--format", "json"});
    CHECK(run.status == 5);
    const auto json = nlohmann::json::parse(run.out);
    REQUIRE(json["files"].size() == 3);
    CHECK(json["files"][0]["sound"] == true);
    CHECK(json["files"][1]["sound"] == false);
    CHECK(json["files"][1]["error"].get<std::string>().starts_with("NKD10"));
    CHECK(json["files"][2]["sound"] == true);
  }

  TEST_CASE("a material's name that is not UTF-8 does not stop info") {
    const Terminal t;
    t.write("latin.mtl", "newmtl caf\xe9\nKd 1 0 0\n");
    t.write("latin.obj", "mtllib latin.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl caf\xe9\nf 1 2 3\n");
    t.succeeds(kTool, {"build", "latin.obj", "-o", "latin.nkd"});
    t.succeeds(kTool, {"info", "latin.nkd"});
    CHECK(t.report(kTool, {"info", "latin.nkd", "--format", "json"})["triangles"] == 1);
  }

  TEST_CASE("info that stdout does not take is an error") {
    const Terminal t;
    t.succeeds(kTool, {"build", data_file("quad.obj"), "-o", "q.nkd"});
    Conditions full;
    full.stdout_file = "/dev/full";
    CHECK(t.run(kTool, {"info", "q.nkd"}, full).status == static_cast<int>(ErrorClass::output));
  }

  TEST_CASE("flatc reads what kdbuild wrote") {
    const Terminal t;
    write_full_object(t);
    const auto printed =
        system_output("flatc", "--json --strict-json --raw-binary -o " + t.path("") + " " +
                                   (source_root() / "schema" / "nkd.fbs").string() + " -- " + t.path("full.nkd"));
    if (!printed) return;
    const auto object = nlohmann::json::parse(t.read("full.json"));
    CHECK(object["version"] == nkd::kFormatVersion);
    CHECK(object["bits"] == 21);
    CHECK(object["triangles"].size() == 4 * triple_bytes(2) + kTripleMargin);
    CHECK(object["material_names"] == nlohmann::json{"red", "blue"});
    CHECK(object["source_primitives"] == nlohmann::json{1, 2, 3, 4});
  }
}
