// The AOV table and the list that --aov takes.
#include "image/channels.h"

#include <set>
#include <string>

#include <doctest/doctest.h>

using namespace kd;
using namespace kd::image;

TEST_CASE("channels: names are read in their order, repeated ones once") {
  const auto aovs = parse_aovs("normal,depth,normal,bary");
  REQUIRE(aovs);
  CHECK(*aovs == std::vector<Aov>{Aov::normal, Aov::depth, Aov::bary});
  REQUIRE(parse_aovs(""));
  CHECK(parse_aovs("")->empty());
  for (const AovRow& row : kAovRows) CHECK(*parse_aovs(row.name) == std::vector<Aov>{row.aov});
}

TEST_CASE("channels: an unknown or empty name lists those there are") {
  for (const char* names : {"depht", "depth,,normal", "depth,", ",", " depth", "Depth"}) {
    CAPTURE(std::string(names));
    const auto aovs = parse_aovs(names);
    REQUIRE(!aovs);
    CHECK(aovs.error().error_class == ErrorClass::usage);
    CHECK(aovs.error().what.find("depth, normal, position, object, instance, primitive, bary") != std::string::npos);
  }
}

TEST_CASE("channels: no two AOVs share a channel, and none is a colour's") {
  std::set<std::string_view> seen{"R", "G", "B", "A"};
  for (const AovRow& row : kAovRows) {
    for (int c = 0; c < 3; ++c) {
      const std::string_view channel = row.channels[static_cast<size_t>(c)];
      CHECK(channel.empty() == (c >= row.components));
      if (!channel.empty()) CHECK(seen.insert(channel).second);
    }
  }
}
