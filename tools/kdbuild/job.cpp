#include "kdbuild/job.h"

#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "common/console.h"
#include "scene/write_scene.h"

namespace kd::tools {

namespace fs = std::filesystem;

std::string Job::base() const {
  const fs::path path = object;
  return path.extension() == ".nkd" ? (path.parent_path() / path.stem()).string() : object;
}

std::string Job::name() const { return fs::path(base()).filename().string(); }

bool names_folder(const std::string& output) {
  std::error_code none;
  return output.ends_with('/') || fs::is_directory(output, none);
}

Result<std::vector<Job>> plan_jobs(const std::vector<std::string>& inputs, const std::string& output) {
  const bool folder = names_folder(output);
  if (inputs.size() > 1 && !folder) {
    return Error{ErrorClass::usage, output,
                 fmt::format("not a folder, but there are {} inputs: end its name in /", inputs.size())};
  }
  std::vector<Job> jobs;
  std::map<std::string, std::string> input_of;
  for (const std::string& input : inputs) {
    const std::string file = fs::path(input).stem().string() + ".nkd";
    jobs.push_back({input, folder ? (fs::path(output) / file).string() : output});
    const auto [other, fresh] = input_of.emplace(jobs.back().object, input);
    if (!fresh) {
      return Error{ErrorClass::usage, jobs.back().object,
                   fmt::format("{} and {} would both be written to it: rename one", other->second, input)};
    }
  }
  return jobs;
}

Result<void> Claims::add(const std::vector<std::string>& outputs) {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> all = files_.outputs;
  all.insert(all.end(), outputs.begin(), outputs.end());
  if (auto distinct = check_distinct(all, files_.inputs); !distinct) return distinct;
  files_.outputs = std::move(all);
  return {};
}

Result<void> Claims::check_scene(const std::string& path) const {
  std::error_code none;
  if (force_ || !fs::exists(path, none) || scene::is_as_written(path)) return {};
  return Error{ErrorClass::output, path,
               "would be replaced, but kdbuild did not write it, or it was edited since: rename it, or use --force"};
}

}  // namespace kd::tools
