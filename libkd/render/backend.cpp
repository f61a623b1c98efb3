#include "render/backend.h"

#include <algorithm>
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
constexpr const char* kNotBuilt = "this build has no CUDA backend (configured with KD_CUDA=OFF, or without nvcc)";
Result<int> cuda_count() { return Error{ErrorClass::device, "", kNotBuilt}; }
Result<std::string> cuda_probe(int) { return Error{ErrorClass::device, "", kNotBuilt}; }
#endif

/// In the order in which "auto" tries them.
constexpr std::array kBackends {
#if KD_WITH_CUDA
  Backend{"cuda", cuda_count, cuda_probe, cuda_open, cuda_trace},
#else
  Backend{"cuda", cuda_count, cuda_probe, nullptr, nullptr},
#endif
      Backend{"cpu", cpu_count, cpu_probe, cpu_open, cpu_trace},
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

/// The devices that one name of the list stands for.
Result<std::vector<Device>> named_devices(std::string_view name) {
  const std::string where = fmt::format("--device {}", name);
  const Error no_device{ErrorClass::usage, where,
                        "not a device: use auto, cpu, cuda, cuda:N, cuda:all, or a list such as cuda:0,cuda:1"};
  const size_t colon = name.find(':');
  const std::string_view index = colon == std::string_view::npos ? "0" : name.substr(colon + 1);
  const auto backend = std::find_if(kBackends.begin(), kBackends.end(),
                                    [&](const Backend& b) { return b.name == name.substr(0, colon); });
  if (backend == kBackends.end() || (backend->name == "cpu" && colon != std::string_view::npos)) return no_device;
  int first = 0, last = 0;
  if (index == "all") {
    const auto count = backend->count();
    if (!count) return Error{count.error().error_class, where, count.error().line()};
    last = *count - 1;
  } else {
    const auto parsed = std::from_chars(index.data(), index.data() + index.size(), first);
    if (parsed.ec != std::errc{} || parsed.ptr != index.data() + index.size() || first < 0) return no_device;
    last = first;
  }
  std::vector<Device> devices;
  for (int i = first; i <= last; ++i) {
    auto description = backend->probe(i);
    if (!description) return Error{description.error().error_class, where, description.error().line()};
    devices.push_back({&*backend, i, *description, ""});
  }
  return devices;
}

}  // namespace

bool built_with_cuda() { return KD_WITH_CUDA; }

Device cpu_device() { return {&kBackends.back(), 0, *cpu_probe(0), ""}; }

Result<std::vector<Device>> choose_devices(std::string_view wanted) {
  if (wanted == "auto") {
    auto device = choose_automatically();
    if (!device) return device.error();
    return std::vector{*device};
  }
  std::vector<Device> devices;
  for (size_t begin = 0; begin <= wanted.size();) {
    const size_t end = std::min(wanted.find(',', begin), wanted.size());
    auto named = named_devices(wanted.substr(begin, end - begin));
    if (!named) return named.error();
    for (Device& device : *named) {
      const bool twice = std::any_of(devices.begin(), devices.end(), [&](const Device& d) {
        return d.backend == device.backend && d.index == device.index;
      });
      if (twice) {
        return Error{ErrorClass::usage, fmt::format("--device {}", wanted), device.description + " is named twice"};
      }
      devices.push_back(std::move(device));
    }
    begin = end + 1;
  }
  return devices;
}

Result<Device> choose_device(std::string_view wanted) {
  auto devices = choose_devices(wanted);
  if (!devices) return devices.error();
  if (devices->size() > 1) {
    return Error{ErrorClass::usage, fmt::format("--device {}", wanted), "this runs on one device: name one"};
  }
  return devices->front();
}

}  // namespace kd::render
