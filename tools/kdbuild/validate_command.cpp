// kdbuild validate: whether objects are sound; every finding with its code.
#include <memory>

#include <fmt/format.h>

#include "common/console.h"
#include "common/report.h"
#include "kdbuild/commands.h"
#include "nkd/validate.h"

namespace kd::tools {

namespace {

/// A tree over float32 vertices was built over lattice points, and only for those can it be exact.
constexpr const char* kRounded =
    " (vertices in float32: the tree was checked against the lattice points nearest to them)";

struct Options {
  std::vector<std::string> files;
  std::string format = "text";
};

Json finding_json(const nkd::Finding& finding) {
  return {{"code", fmt::format("NKD{}", static_cast<int>(finding.issue))},
          {"text", nkd::issue_text(finding.issue)},
          {"detail", finding.detail}};
}

/// Validates all files, prints as it goes, and returns the status of the first that is not sound.
int run(const Options& options) {
  int status = 0;
  Json report{{"version", 1}, {"files", Json::array()}};
  const bool text = options.format == "text";
  for (const std::string& path : options.files) {
    Json entry{{"file", path}, {"sound", false}};
    auto file = nkd::ObjectFile::open(path);
    if (!file) {
      if (text) fail(kKdbuild, file.error());
      entry["error"] = file.error().what;
      if (status == 0) status = static_cast<int>(file.error().error_class);
    } else {
      const std::vector<nkd::Finding> findings = nkd::validate(*file);
      entry["sound"] = findings.empty();
      entry["findings"] = Json::array();
      for (const nkd::Finding& finding : findings) {
        entry["findings"].push_back(finding_json(finding));
        if (text) fail(kKdbuild, {ErrorClass::object, path, finding.line()});
      }
      const bool rounded = file->geometry().form == VertexForm::float32;
      entry["vertex_form"] = name_of(file->geometry().form);
      if (findings.empty() && text) fmt::print("{}: sound{}\n", path, rounded ? kRounded : "");
      if (!findings.empty() && status == 0) status = static_cast<int>(ErrorClass::object);
    }
    report["files"].push_back(std::move(entry));
  }
  if (!text) {
    if (auto written = write_report("-", report); !written) return fail(kKdbuild, written.error());
  }
  return status;
}

}  // namespace

Command validate_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* c =
      app.add_subcommand("validate", "Check objects in depth: structure, checksums, every leaf against every triangle");
  c->add_option("files", options->files, "One .nkd or more")->required();
  c->add_option("--format", options->format, "text or json")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  return {c, [options] { return run(*options); }};
}

}  // namespace kd::tools
