// Progress: how a long operation says how far it is and hears that it should stop.
#pragma once

#include <functional>

namespace kd {

/// Called now and then, from any thread but never by two at once, with the share done in [0, 1]. Returns false to
/// cancel; the operation then ends with ErrorClass::interrupted and leaves nothing behind.
using Progress = std::function<bool(double share)>;

inline bool keep_going(const Progress& progress, double share) { return !progress || progress(share); }

}  // namespace kd
