#include "render/backend.h"

#include <array>
#include <charconv>

#include <fmt/format.h>

#include "render/cpu_backend.h"
#if KD_WITH_CUDA
#include "render/cuda/cuda_backend.h"
#endif

namespace kd::render {

namespace {

#if !KD_WITH_CUDA
Result<std::string> cuda_not_built(int) {
  return Error{ErrorClass::device, "", "this build has no CUDA backend (configured with KD_CUDA=OFF, or without nvcc)"};
}
#endif

/// In the order in which "auto" tries them.
constexpr std::array kBackends {
#if KD_WITH_CUDA
  Backend{"cuda", cuda_probe, cuda_render, cuda_trace},
#else
  Backend{"cuda", cuda_not_built, nullptr, nullptr},
#endif
      Backend{"cpu", cpu_probe, cpu_render, cpu_trace},
};

Result<Device> choose_automatically() {
  std::string reason;
  for (const Backend& backend : kBackends) {
    auto description = backend.probe(0);
    if (description) {
      return Device{&backend, 0, *description, reason.empty() ? "it is the first there is" : reason};
    }
    reason += fmt::format("{}{}: {}", reason.empty() ? "" : "; ", backend.name, description.error().line());
  }
  return Error{ErrorClass::device, "--device auto", reason};
}

}  // namespace

bool built_with_cuda() { return KD_WITH_CUDA; }

Result<Device> choose_device(std::string_view wanted) {
  if (wanted == "auto") return choose_automatically();
  const std::string where = fmt::format("--device {}", wanted);
  const size_t colon = wanted.find(':');
  const std::string_view name = wanted.substr(0, colon);
  int index = 0;
  if (colon != std::string_view::npos) {
    const std::string_view digits = wanted.substr(colon + 1);
    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (name == "cpu" || parsed.ec != std::errc{} || parsed.ptr != digits.data() + digits.size() || index < 0) {
      return Error{ErrorClass::usage, where, "not a device: use auto, cpu, cuda or cuda:N"};
    }
  }
  for (const Backend& backend : kBackends) {
    if (backend.name != name) continue;
    auto description = backend.probe(index);
    if (!description) return Error{description.error().error_class, where, description.error().line()};
    return Device{&backend, index, *description, ""};
  }
  return Error{ErrorClass::usage, where, "not a device: use auto, cpu, cuda or cuda:N"};
}

}  // namespace kd::render
