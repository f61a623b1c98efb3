#include "cli/run_tool.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kd::test {

namespace fs = std::filesystem;

namespace {

std::string slurp(std::istream& in) { return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()}; }

std::string slurp(std::FILE* file) {
  std::string text;
  std::rewind(file);
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += static_cast<char>(c);
  return text;
}

/// In the child: never returns. Only what is safe after fork.
[[noreturn]] void become(const char* program, char* const* arguments, const char* folder, const Conditions& conditions,
                         int out, int err) {
  if (conditions.largest_file) {
    const rlimit limit{*conditions.largest_file, *conditions.largest_file};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  if (!conditions.stdout_file.empty()) out = open(conditions.stdout_file.c_str(), O_WRONLY);
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  if (chdir(folder) == 0) execv(program, arguments);
  _exit(127);
}

/// Waits, with the signals that the conditions ask for; the status as in ToolRun.
int wait_for(pid_t child, const Conditions& conditions) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  bool signal_due = conditions.signal != 0;
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    const auto passed = Clock::now() - start;
    if (signal_due && passed >= conditions.signal_after) {
      kill(child, conditions.signal);
      signal_due = false;
    }
    if (passed > conditions.patience) kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace

ToolRun Terminal::run(const std::string& tool, const Arguments& arguments, const Conditions& conditions) const {
  const std::string program = (fs::path(KD_BIN_DIR) / tool).string();
  std::vector<std::string> words{tool};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  std::FILE *out = std::tmpfile(), *err = std::tmpfile();
  REQUIRE((out && err));
  const std::string folder = workshop_.folder().string();
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) become(program.c_str(), argv.data(), folder.c_str(), conditions, fileno(out), fileno(err));
  ToolRun result;
  result.status = wait_for(child, conditions);
  result.out = slurp(out);
  result.err = slurp(err);
  std::fclose(out);
  std::fclose(err);
  return result;
}

ToolRun Terminal::succeeds(const std::string& tool, const Arguments& arguments) const {
  ToolRun result = run(tool, arguments);
  CHECK_MESSAGE(result.status == 0, result.err);
  CHECK(result.err == "");
  return result;
}

ToolRun Terminal::fails(const std::string& tool, const Arguments& arguments, ErrorClass error_class,
                        const std::vector<std::string>& fragments, const Conditions& conditions) const {
  std::string line = tool;
  for (const std::string& argument : arguments) line += ' ' + argument;
  CAPTURE(line);
  const auto before = snapshot();
  ToolRun result = run(tool, arguments, conditions);
  CAPTURE(result.err);
  CHECK(result.status == static_cast<int>(error_class));
  const bool one_line = result.err.find('\n') + 1 == result.err.size() && result.err.starts_with(tool + ": error: ");
  CHECK(one_line);
  for (const std::string& fragment : fragments) {
    const bool is_named = !one_line || result.err.find(fragment) != std::string::npos;
    CHECK_MESSAGE(is_named, fragment);
  }
  const auto after = snapshot();
  for (const auto& [name, bytes] : after) CHECK_MESSAGE(before.contains(name), "left behind: ", name);
  for (const auto& [name, bytes] : before)
    CHECK_MESSAGE((after.contains(name) && after.at(name) == bytes), "changed: ", name);
  return result;
}

nlohmann::json Terminal::report(const std::string& tool, const Arguments& arguments) const {
  const ToolRun result = succeeds(tool, arguments);
  auto json = nlohmann::json::parse(result.out, nullptr, false);
  REQUIRE_MESSAGE(!json.is_discarded(), result.out);
  return json;
}

bool Terminal::exists(const std::string& name) const { return fs::exists(path(name)); }

void Terminal::write(const std::string& name, const std::string& bytes) const {
  std::ofstream file(path(name), std::ios::binary);
  file << bytes;
  REQUIRE(file.flush());
}

std::string Terminal::read(const std::string& name) const {
  std::ifstream file(path(name), std::ios::binary);
  REQUIRE_MESSAGE(file, name);
  return slurp(file);
}

std::map<std::string, std::string> Terminal::snapshot() const {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(workshop_.folder())) {
    std::ifstream file;
    if (entry.is_regular_file()) file.open(entry.path(), std::ios::binary);
    files[entry.path().lexically_relative(workshop_.folder()).string()] = slurp(file);
  }
  return files;
}

std::string data_file(const std::string& name) { return (source_root() / "data" / name).string(); }

std::optional<std::string> system_output(const std::string& program, const std::string& arguments) {
  if (std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) != 0) {
    MESSAGE("skipped: " << program << " is not installed");
    return std::nullopt;
  }
  std::FILE* pipe = popen((program + " " + arguments + " 2>&1").c_str(), "r");
  REQUIRE(pipe);
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  CHECK_MESSAGE(pclose(pipe) == 0, text);
  return text;
}

}  // namespace kd::test
