#pragma once

#include <string>
#include <vector>

namespace pixelflex::viewer {

// What the bodies of requests mean. All throw RemoteError, whose message says how to write it.

/// {"on": true}
[[nodiscard]] bool parseOn(const std::string& body);

/// {"pan": 12.5, "mute": true, "input": "hdmi"} or ["pan=12.5", "brightness+=5", "home"]: what `pixelflex device` takes
/// behind a device's name.
[[nodiscard]] std::vector<std::string> parseSteps(const std::string& body);

struct RestoreOrder {
  bool verify = false;
  bool dryRun = false;
};
/// {}, {"verify": true}, {"dry_run": true}
[[nodiscard]] RestoreOrder parseRestore(const std::string& body);

/// {"steps": ["surface"], "all": true, "check": true, "only": ["p1"], "skip": ["p2"], "method": "dense"}, each of them
/// optional: arguments of `pixelflex calibrate` that name no file.
[[nodiscard]] std::vector<std::string> parseCalibrate(const std::string& body);

/// {} or nothing.
void parseNothing(const std::string& body);

}  // namespace pixelflex::viewer
