#include "tests/support/certificates.h"

#include <fstream>
#include <stdexcept>
#include <vector>

#include "tests/support/process.h"

namespace pixelflex::testing {
namespace {

std::string openssl(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "openssl");
  const Output output = run(arguments);
  if (output.status != 0) throw std::runtime_error("openssl: " + output.text);
  return output.text;
}

}  // namespace

Certificates::Certificates(const std::string& names) {
  const auto path = [this](const char* name) { return (folder_ / name).string(); };
  std::ofstream(path("names")) << "subjectAltName=" << names << "\nextendedKeyUsage=serverAuth\n";
  const std::vector<std::string> newKey{"-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes"};
  std::vector<std::string> ca{"req", "-x509",   "-subj",        "/CN=authority", "-days",
                              "2",   "-keyout", path("ca.key"), "-out",          authority()};
  std::vector<std::string> request{"req", "-subj", "/CN=a wall", "-keyout", key(), "-out", path("request")};
  for (auto* command : {&ca, &request}) command->insert(command->end(), newKey.begin(), newKey.end());
  openssl(ca);
  openssl(request);
  openssl({"x509", "-req", "-in", path("request"), "-CA", authority(), "-CAkey", path("ca.key"), "-CAcreateserial",
           "-days", "2", "-extfile", path("names"), "-out", certificate()});
}

std::string Certificates::fingerprint() const {
  std::string text = openssl({"x509", "-in", certificate(), "-noout", "-fingerprint", "-sha256"});
  text.erase(0, text.find('=') + 1);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace pixelflex::testing
