// data: URIs.
#include <doctest/doctest.h>

#include "gltf_texts.h"
#include "mesh/data_uri.h"

using namespace kd;
using namespace kd::mesh;

namespace {

/// What is decoded, as text; "-" for what is refused.
std::string decoded(std::string_view uri) {
  const Progress unwatched;
  Watch watch(unwatched);
  const auto bytes = decode_data_uri(uri, watch);
  return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "-";
}

}  // namespace

TEST_CASE("data: URIs, of any media type, padded or not") {
  // The test vectors of RFC 4648, section 10.
  CHECK(decoded("data:;base64,Zg==") == "f");
  CHECK(decoded("data:text/plain;charset=x;base64,Zm8=") == "fo");
  CHECK(decoded("data:;base64,Zm9v") == "foo");
  CHECK(decoded("data:application/gltf-buffer;base64,Zm9vYg") == "foob");
  CHECK(decoded("data:;base64,Zm9vYmE=") == "fooba");
  CHECK(decoded("data:;base64,Zm9vYmFy") == "foobar");
  std::string all;
  for (int i = 0; i < 256; ++i) all += static_cast<char>(i);
  CHECK(decoded(kd::test::data_uri(all)) == all);
  for (const char* bad : {"", "data:", "data:,foo", "data:;base64,", "data:;base64,====", "data:;base64,Z",
                          "data:;base64,Zm9vY", "data:;base64,Zm 9v", "data:;base64,Zm-v",
                          "data:;base64,Z===", "data:text/plain,Zg==", "file:;base64,Zg==", "data:;base64,Zg==Zg=="}) {
    CAPTURE(std::string(bad));
    CHECK(decoded(bad) == "-");
  }
}
