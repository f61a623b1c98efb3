// OpenEXR files read back through OpenEXR's own reader: every channel's bits, the header, and what a failure leaves.
#include "image/exr.h"

#include <bit>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include "support/temp_folder.h"

using namespace kd;
using namespace kd::image;

namespace {

/// A film with all AOVs; no two words are the same, and NaNs, infinities and all bits set are among them.
Film make_film(uint32_t width, uint32_t height) {
  Film film;
  film.width = width;
  film.height = height;
  const size_t pixels = size_t{width} * height;
  for (size_t i = 0; i < 4 * pixels; ++i) film.colour.push_back(static_cast<float>(i) * 0.37f - 5.0f);
  film.colour[1] = std::numeric_limits<float>::infinity();
  uint32_t word = 0x3f000000u;
  for (const AovRow& row : kAovRows) {
    AovBuffer buffer{row.aov, {}};
    for (size_t i = 0; i < static_cast<size_t>(row.components) * pixels; ++i) buffer.words.push_back(word++);
    buffer.words.front() = row.type == ChannelType::uint32 ? 0xffffffffu : std::bit_cast<uint32_t>(INFINITY);
    film.aovs.push_back(std::move(buffer));
  }
  return film;
}

std::vector<uint32_t> read_channel(Imf::InputFile& file, const std::string& name, Imf::PixelType type) {
  const Imath::Box2i window = file.header().dataWindow();
  const auto width = static_cast<size_t>(window.max.x + 1), height = static_cast<size_t>(window.max.y + 1);
  std::vector<uint32_t> words(width * height);
  Imf::FrameBuffer frame;
  frame.insert(name, Imf::Slice(type, reinterpret_cast<char*>(words.data()), 4, 4 * width));
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  return words;
}

/// Whether `read` is component `first` of an interleaved buffer, bit for bit.
template <class T>
bool same_bits(const std::vector<uint32_t>& read, const std::vector<T>& buffer, size_t first, size_t components) {
  if (read.size() * components != buffer.size()) return false;
  for (size_t i = 0; i < read.size(); ++i) {
    if (read[i] != std::bit_cast<uint32_t>(buffer[i * components + first])) return false;
  }
  return true;
}

/// Files cannot grow past `bytes` while one lives: a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

}  // namespace

TEST_CASE("exr: every channel comes back bit for bit") {
  const kd::test::TempFolder folder;
  const std::string path = folder.file("all.exr");
  const Film film = make_film(37, 21);
  const auto written = write_exr(path, film, {});
  REQUIRE_MESSAGE(written, written.error().line());

  Imf::InputFile file(path.c_str());
  CHECK(file.isComplete());
  CHECK(file.header().compression() == Imf::ZIP_COMPRESSION);
  CHECK(file.header().dataWindow() == Imath::Box2i({0, 0}, {36, 20}));
  size_t channels = 4;
  const char* colour[] = {"R", "G", "B", "A"};
  for (size_t c = 0; c < 4; ++c) CHECK(same_bits(read_channel(file, colour[c], Imf::FLOAT), film.colour, c, 4));
  for (const AovBuffer& buffer : film.aovs) {
    const AovRow& row = aov_row(buffer.aov);
    const auto type = row.type == ChannelType::float32 ? Imf::FLOAT : Imf::UINT;
    const auto components = static_cast<size_t>(row.components);
    for (size_t c = 0; c < components; ++c, ++channels) {
      const std::string name(row.channels[c]);
      CAPTURE(name);
      REQUIRE(file.header().channels().findChannel(name));
      CHECK(file.header().channels()[name.c_str()].type == type);
      CHECK(same_bits(read_channel(file, name, type), buffer.words, c, components));
    }
  }
  size_t written_channels = 0;
  for (auto c = file.header().channels().begin(); c != file.header().channels().end(); ++c) ++written_channels;
  CHECK(written_channels == channels);
}

TEST_CASE("exr: the header holds what was asked for and no more") {
  const kd::test::TempFolder folder;
  Film film = make_film(1, 1);
  film.aovs.clear();
  REQUIRE(write_exr(folder.file("plain.exr"), film, {}));
  Imf::InputFile plain(folder.file("plain.exr").c_str());
  CHECK(!plain.header().findTypedAttribute<Imf::FloatAttribute>("gamma"));
  CHECK(!plain.header().findTypedAttribute<Imf::StringAttribute>("software"));

  const ExrHeader header{2.2, "kdrender 0.1", {{"kd.scene", "shots/scene.json"}, {"kd.backend", "cpu"}}};
  REQUIRE(write_exr(folder.file("full.exr"), film, header));
  Imf::InputFile full(folder.file("full.exr").c_str());
  CHECK(full.header().typedAttribute<Imf::FloatAttribute>("gamma").value() == 2.2f);
  CHECK(full.header().typedAttribute<Imf::StringAttribute>("software").value() == "kdrender 0.1");
  CHECK(full.header().typedAttribute<Imf::StringAttribute>("kd.scene").value() == "shots/scene.json");
  CHECK(full.header().typedAttribute<Imf::StringAttribute>("kd.backend").value() == "cpu");
}

TEST_CASE("exr: exrinfo, where it is installed, accepts the file") {
  if (std::system("command -v exrinfo > /dev/null 2>&1") != 0) return;
  const kd::test::TempFolder folder;
  REQUIRE(write_exr(folder.file("all.exr"), make_film(64, 48), {2.2, "kdrender", {}}));
  CHECK(std::system(fmt::format("exrinfo -s '{}' > /dev/null", folder.file("all.exr")).c_str()) == 0);
}

TEST_CASE("exr: what cannot be written is an output error and leaves nothing behind") {
  const kd::test::TempFolder folder;
  const Film film = make_film(64, 64);
  const auto fails = [&](const std::string& path, const Film& f, const ExrHeader& header) {
    const auto written = write_exr(path, f, header);
    REQUIRE(!written);
    CHECK(written.error().error_class == ErrorClass::output);
    CHECK(written.error().where == path);
    CHECK(folder.is_empty());
  };
  const std::string path = folder.file("out.exr");
  fails(folder.file("no/such/folder.exr"), film, {});
  fails(path, film, {std::nullopt, "", {{"channels", "taken by OpenEXR"}}});
  fails(path, film, {std::nullopt, "", {{"", "no name"}}});
  fails(path, Film{}, {});
  Film short_film = film;
  short_film.aovs[1].words.pop_back();
  fails(path, short_film, {});
  for (const rlim_t bytes : {0, 100, 600, 2000, 20000}) {
    CAPTURE(bytes);
    const FileSizeLimit limit(bytes);
    fails(path, film, {});
  }
}

TEST_CASE("exr: a failure leaves the file that was there") {
  const kd::test::TempFolder folder;
  const std::string path = folder.file("out.exr");
  REQUIRE(write_exr(path, make_film(8, 8), {}));
  const auto size = std::filesystem::file_size(path);
  CHECK(!write_exr(path, make_film(9, 9), {std::nullopt, "", {{"channels", "taken"}}}));
  CHECK(std::filesystem::file_size(path) == size);
  CHECK(Imf::InputFile(path.c_str()).header().dataWindow().max.x == 7);
}
