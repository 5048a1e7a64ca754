#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viewer/renderer/wall_renderer.h"
#include "viewer/tiles/stage_stats.h"

namespace pixelflex::viewer {

/// "receive 0.1/0.4/2.0 decode … total 3.1/8.0/12.5": median, 99th percentile and maximum of each stage, milliseconds.
[[nodiscard]] std::string stagesText(const StageSummary& stages);

/// What was done in a span of time.
struct Account {
  double seconds = 0;  // since the start, at its end
  std::uint64_t updates = 0;
  RenderStats render;  // in this span alone
  StageSummary stages;
  bool total = false;  // of all that was done
};

/// A table of the stages for a panel, under the number of updates.
[[nodiscard]] std::vector<std::string> panelText(const Account& account);

/// How a line begins: "stats:", or "stats of :1.0:" where there are several displays (else `display` is empty).
[[nodiscard]] std::string headOf(const std::string& word, const std::string& display);
/// A JSON object's first member, with its comma: "display", or nothing.
[[nodiscard]] std::string jsonHeadOf(const std::string& display);

/// One JSON object without line breaks, after jsonHeadOf():
/// {"seconds":S,"total":false,"updates":N,"bytes_uploaded":N,"outputs_drawn":N,"pixels_drawn":N,"timed_updates":N,
/// "stages_ms":{"receive":{"median":T,"p99":T,"max":T},…}}
[[nodiscard]] std::string jsonOf(const Account& account, const std::string& display);

}  // namespace pixelflex::viewer
