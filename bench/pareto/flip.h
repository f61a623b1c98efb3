// LDR-FLIP: how different two images look when one is flipped to the other in place. Andersson, Nilsson,
// Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for Alternating Images", Proc. ACM
// Comput. Graph. Interact. Tech. 3(2) (HPG 2020); sections below are that paper's.
#pragma once

#include <vector>

#include "pareto/picture.h"

namespace kd::bench {

/// What the paper assumes (section 5): a display 0.7 m wide with 3840 pixels, seen from 0.7 m.
constexpr double kPixelsPerDegree = 67.0206;

/// The difference at each pixel, in [0, 1], in the pictures' order. `reference` and `test` are sRGB-encoded, in [0, 1],
/// of one size, not empty. Symmetric; 0 where the colours seen are the same.
std::vector<float> flip_map(const Picture& reference, const Picture& test, double pixels_per_degree = kPixelsPerDegree);

/// The mean of the map, the figure the paper gives a pair of images (section 6).
double flip(const Picture& reference, const Picture& test, double pixels_per_degree = kPixelsPerDegree);

}  // namespace kd::bench
