#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "devices/image/image.h"
#include "devices/serve/gige_messages.h"

namespace pixelflex::devices {

/// What a GigE Vision camera keeps: its description for programs (GenICam) and its settings, as Aravis' fake camera has
/// them. Thread-safe.
class GigeRegisters {
 public:
  GigeRegisters(const std::string& serial, Size size, const std::string& address);
  ~GigeRegisters();
  GigeRegisters(const GigeRegisters&) = delete;
  GigeRegisters& operator=(const GigeRegisters&) = delete;

  // Registers of every GigE Vision device.
  static constexpr std::uint32_t kHeartbeatTimeout = 0x0938;  // milliseconds
  static constexpr std::uint32_t kPrivilege = 0x0a00;         // 0: nobody controls the camera
  static constexpr std::uint32_t kStreamPort = 0x0d00;
  static constexpr std::uint32_t kPacketSize = 0x0d04;
  static constexpr std::uint32_t kStreamAddress = 0x0d18;

  [[nodiscard]] std::uint32_t read(std::uint32_t address) const;
  void write(std::uint32_t address, std::uint32_t value);
  /// None beyond what there is.
  [[nodiscard]] std::optional<Bytes> readBlock(std::uint32_t address, std::uint32_t size) const;
  bool writeBlock(std::uint32_t address, const Bytes& bytes);

  [[nodiscard]] bool acquires() const;
  void stopAcquisition();
  [[nodiscard]] bool wantsOneFrame() const;
  [[nodiscard]] bool isTriggered() const;
  /// Whether a trigger has come since the last call.
  [[nodiscard]] bool takeTrigger();
  [[nodiscard]] double framePeriod() const;  // seconds, of frames that nobody triggers
  [[nodiscard]] double exposure() const;     // seconds
  /// A photograph in the pixel format and region that are set.
  [[nodiscard]] GigeFrame frameOf(const Image8& photo) const;

 private:
  struct Bank;
  std::unique_ptr<Bank> bank_;
  mutable std::mutex mutex_;
};

}  // namespace pixelflex::devices
