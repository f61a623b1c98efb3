// What tells one state of a source from another: a hash over all the files that it is made of.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sys/progress.h"
#include "sys/result.h"

namespace kd::tools {

struct Fingerprint {
  /// XXH3-64 of the source's bytes; if it names further files, of the hashes of them all, 0 for one that is not there.
  uint64_t hash = 0;
  std::vector<std::string> named;  // the further files, there or not
  std::vector<std::string> files;  // the source, and what is there of the further ones
};

/// The fingerprint of `input` and of the files that it names. ErrorClass::missing if `input` cannot be read,
/// ErrorClass::interrupted if `progress`, which is asked with a share of 0, cancels.
Result<Fingerprint> fingerprint(const std::string& input, const Progress& progress);

/// `known`, which `fingerprint(input)` gave before the source was read, if it covers all that the reader then said the
/// mesh depends on, as it should; else one that does. It differs from what the next look will give, so an object that
/// records it is never taken for up to date.
Result<Fingerprint> extended(const std::string& input, Fingerprint known, const std::vector<std::string>& dependencies,
                             const Progress& progress);

}  // namespace kd::tools
