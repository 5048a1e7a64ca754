#include "viewer/control/device_run.h"

#include <exception>
#include <mutex>
#include <thread>

#include "devices/projector_control/device_factory.h"
#include "devices/transport/line_loop.h"

namespace pixelflex::viewer {
namespace {

using Kind = DeviceStep::Kind;

/// A device of its own thread at its steps.
class Runner {
 public:
  Runner(devices::Device& device, const devices::Progress& progress, DeviceOutcome& outcome)
      : device_(device), progress_(progress), outcome_(outcome) {}

  void readAll() {
    outcome_.identity = device_.identity();
    for (const auto& info : device_.settings()) {
      if (info.readable) read(info);
    }
  }

  void take(const std::vector<DeviceStep>& steps) {
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const DeviceStep& step = steps[i];
      // What is set in a row is set at once: both axes of a mirror move together.
      std::vector<std::pair<std::string, devices::SettingValue>> values;
      while (i < steps.size() && steps[i].kind == Kind::kWrite) {
        values.emplace_back(steps[i].name, steps[i].value);
        ++i;
      }
      if (!values.empty()) {
        device_.writeAll(values, progress_);
        --i;
      } else {
        takeOne(step);
      }
      if (progress_.stop.stop_requested()) return;
    }
  }

 private:
  void takeOne(const DeviceStep& step) {
    if (step.kind == Kind::kHalt) return device_.halt();
    if (step.kind == Kind::kAct) return device_.act(step.name, progress_);
    if (step.kind == Kind::kNudge) return device_.nudge(step.name, step.by, progress_);
    const auto value = devices::textOf(device_.read(step.name));
    for (const auto& info : device_.settings()) {
      if (info.name == step.name) outcome_.values.emplace_back(info, value);
    }
  }

  /// A setting that cannot be told now is no reason not to tell the others.
  void read(const devices::SettingInfo& info) {
    try {
      outcome_.values.emplace_back(info, devices::textOf(device_.read(info.name)));
    } catch (const devices::DeviceError&) {
      outcome_.values.emplace_back(info, "");
    }
  }

  devices::Device& device_;
  const devices::Progress& progress_;
  DeviceOutcome& outcome_;
};

}  // namespace

void runDeviceSteps(devices::Device& device, const std::vector<DeviceStep>& steps, const devices::Progress& progress,
                    DeviceOutcome& outcome) {
  Runner(device, progress, outcome).take(steps);
}

std::unique_ptr<devices::Device> openDevice(devices::LineLoop& loop, const calib::WallDevice& device,
                                            std::chrono::milliseconds infocusGap) {
  return devices::makeDevice(loop, {.name = device.name,
                                    .driver = device.line.driver,
                                    .at = device.line.at,
                                    .password = calib::passwordOf(device),
                                    .infocusGap = infocusGap});
}

std::vector<DeviceOutcome> runDeviceJobs(devices::LineLoop& loop, const std::vector<DeviceJob>& jobs,
                                         const DeviceRunOptions& options) {
  std::vector<DeviceOutcome> outcomes(jobs.size());
  std::mutex reporting;
  const auto runOne = [&](std::size_t i) {
    const DeviceJob& job = jobs[i];
    DeviceOutcome& outcome = outcomes[i];
    outcome.device = job.device;
    const devices::Progress progress{.stop = options.stop, .report = [&](const std::string& state) {
                                       const std::lock_guard lock(reporting);
                                       if (options.report) options.report(job.device.name, state);
                                     }};
    try {
      const auto device = openDevice(loop, job.device, options.infocusGap);
      Runner runner(*device, progress, outcome);
      if (job.steps.empty()) {
        runner.readAll();
      } else {
        runner.take(job.steps);
      }
    } catch (const std::exception& error) {
      outcome.error = error.what();
    }
  };
  std::vector<std::jthread> threads;
  for (std::size_t i = 0; i < jobs.size(); ++i) threads.emplace_back(runOne, i);
  threads.clear();
  return outcomes;
}

}  // namespace pixelflex::viewer
