#include "viewer/programs/stats_text.h"

#include <fmt/format.h>

namespace pixelflex::viewer {
namespace {

double milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

}  // namespace

std::string stagesText(const StageSummary& stages) {
  std::string text;
  for (std::size_t i = 0; i < kStages; ++i) {
    const StageFigures& figures = stages.stages[i];
    text += fmt::format("{}{} {:.1f}/{:.1f}/{:.1f}", i == 0 ? "" : "  ", nameOf(static_cast<Stage>(i)),
                        milliseconds(figures.median), milliseconds(figures.p99), milliseconds(figures.max));
  }
  return text;
}

std::vector<std::string> panelText(const Account& account) {
  std::vector<std::string> lines = {fmt::format("updates {:3}  drawn {:.1f} Mpx", account.updates,
                                                static_cast<double>(account.render.pixelsDrawn) / 1e6),
                                    fmt::format("ms      {:>8}{:>8}{:>8}", "median", "p99", "max")};
  for (std::size_t i = 0; i < kStages; ++i) {
    const StageFigures& figures = account.stages.stages[i];
    lines.push_back(fmt::format("{:8}{:8.1f}{:8.1f}{:8.1f}", nameOf(static_cast<Stage>(i)),
                                milliseconds(figures.median), milliseconds(figures.p99), milliseconds(figures.max)));
  }
  return lines;
}

std::string headOf(const std::string& word, const std::string& display) {
  return display.empty() ? word + ":" : word + " of " + display + ":";
}

std::string jsonHeadOf(const std::string& display) {
  if (display.empty()) return {};
  std::string escaped;
  for (const char c : display) escaped += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  return R"("display":")" + escaped + "\",";
}

std::string jsonOf(const Account& account, const std::string& display) {
  std::string stages;
  for (std::size_t i = 0; i < kStages; ++i) {
    const StageFigures& figures = account.stages.stages[i];
    stages += fmt::format(R"({}"{}":{{"median":{:.3f},"p99":{:.3f},"max":{:.3f}}})", i == 0 ? "" : ",",
                          nameOf(static_cast<Stage>(i)), milliseconds(figures.median), milliseconds(figures.p99),
                          milliseconds(figures.max));
  }
  return fmt::format(
      R"({{{}"seconds":{:.3f},"total":{},"updates":{},"bytes_uploaded":{},"outputs_drawn":{},"pixels_drawn":{},)"
      R"("timed_updates":{},"stages_ms":{{{}}}}})",
      jsonHeadOf(display), account.seconds, account.total, account.updates, account.render.bytesUploaded,
      account.render.outputsDrawn, account.render.pixelsDrawn, account.stages.updates, stages);
}

}  // namespace pixelflex::viewer
