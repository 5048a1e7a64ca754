#pragma once

#include <memory>

#include "devices/transport/channel.h"

namespace pixelflex::devices {

[[nodiscard]] std::unique_ptr<Channel> makeSerialChannel(boost::asio::io_context& context, const LineAddress& address);
[[nodiscard]] std::unique_ptr<Channel> makeTcpChannel(boost::asio::io_context& context, const LineAddress& address);
/// A TCP connection whose other end sets its serial line as `address.format` says (RFC 2217).
[[nodiscard]] std::unique_ptr<Channel> makeRfc2217Channel(boost::asio::io_context& context, const LineAddress& address);
/// A simulator in this process. Throws std::invalid_argument when there is none of that kind.
[[nodiscard]] std::unique_ptr<Channel> makeSimulatedChannel(boost::asio::io_context& context,
                                                            const LineAddress& address);

}  // namespace pixelflex::devices
