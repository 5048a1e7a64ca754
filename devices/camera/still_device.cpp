#include "devices/camera/still_device.h"

#include <gphoto2/gphoto2.h>

#include <stdexcept>

namespace pixelflex::devices {
namespace {

struct Release {
  void operator()(Camera* camera) const { gp_camera_unref(camera); }
  void operator()(GPContext* context) const { gp_context_unref(context); }
  void operator()(CameraList* list) const { gp_list_unref(list); }
  void operator()(CameraFile* file) const { gp_file_unref(file); }
  void operator()(CameraWidget* widget) const { gp_widget_unref(widget); }
};
template <class Object>
using Held = std::unique_ptr<Object, Release>;

std::string reason(int result) {
  if (result == GP_ERROR_IO_USB_CLAIM || result == GP_ERROR_CAMERA_BUSY || result == GP_ERROR_IO_LOCK) {
    return "another program uses this camera, often the desktop's file manager: end that first (gio mount -s gphoto2)";
  }
  if (result == GP_ERROR_IO_USB_FIND || result == GP_ERROR_IO) {
    return "the camera does not answer: check its cable, and that it is on and awake";
  }
  return gp_result_as_string(result);
}

void demand(int result) {
  if (result < GP_OK) throw std::runtime_error(reason(result));
}

Held<CameraList> found(GPContext* context) {
  CameraList* list = nullptr;
  demand(gp_list_new(&list));
  Held<CameraList> held(list);
  demand(gp_camera_autodetect(list, context));
  return held;
}

class GphotoDevice final : public StillDevice {
 public:
  GphotoDevice(const std::string& model, const std::string& port) : context_(gp_context_new()) {
    Camera* camera = nullptr;
    demand(gp_camera_new(&camera));
    camera_.reset(camera);
    choosePort(port);
    chooseModel(model);
    demand(gp_camera_init(camera, context_.get()));
  }
  ~GphotoDevice() override { gp_camera_exit(camera_.get(), context_.get()); }
  GphotoDevice(const GphotoDevice&) = delete;
  GphotoDevice& operator=(const GphotoDevice&) = delete;

  [[nodiscard]] std::optional<std::string> value(const std::string& setting) override {
    const auto root = configuration();
    CameraWidget* widget = widgetOf(root.get(), setting);
    const char* text = nullptr;
    if (widget == nullptr || gp_widget_get_value(widget, &text) < GP_OK || text == nullptr) return std::nullopt;
    return text;
  }
  [[nodiscard]] std::vector<std::string> choices(const std::string& setting) override {
    const auto root = configuration();
    CameraWidget* widget = widgetOf(root.get(), setting);
    std::vector<std::string> all;
    for (int i = 0; widget != nullptr && i < gp_widget_count_choices(widget); ++i) {
      const char* text = nullptr;
      if (gp_widget_get_choice(widget, i, &text) >= GP_OK && text != nullptr) all.emplace_back(text);
    }
    return all;
  }
  void set(const std::string& setting, const std::string& value) override {
    const auto root = configuration();
    CameraWidget* widget = widgetOf(root.get(), setting);
    if (widget == nullptr || gp_widget_set_value(widget, value.c_str()) < GP_OK) return;
    (void)gp_camera_set_config(camera_.get(), root.get(), context_.get());
  }
  [[nodiscard]] std::vector<std::uint8_t> capture() override {
    CameraFilePath place{};
    demand(gp_camera_capture(camera_.get(), GP_CAPTURE_IMAGE, &place, context_.get()));
    CameraFile* made = nullptr;
    demand(gp_file_new(&made));
    const Held<CameraFile> file(made);
    demand(gp_camera_file_get(camera_.get(), place.folder, place.name, GP_FILE_TYPE_NORMAL, made, context_.get()));
    const char* data = nullptr;
    unsigned long size = 0;
    demand(gp_file_get_data_and_size(made, &data, &size));
    std::vector<std::uint8_t> bytes(data, data + size);
    // Its memory is small; what cannot be deleted stays for its owner.
    (void)gp_camera_file_delete(camera_.get(), place.folder, place.name, context_.get());
    return bytes;
  }

 private:
  void choosePort(const std::string& port) {
    GPPortInfoList* ports = nullptr;
    demand(gp_port_info_list_new(&ports));
    GPPortInfo info{};
    int result = gp_port_info_list_load(ports);
    if (result >= GP_OK) result = gp_port_info_list_lookup_path(ports, port.c_str());
    if (result >= GP_OK) result = gp_port_info_list_get_info(ports, result, &info);
    if (result >= GP_OK) result = gp_camera_set_port_info(camera_.get(), info);
    gp_port_info_list_free(ports);
    demand(result);
  }
  void chooseModel(const std::string& model) {
    CameraAbilitiesList* models = nullptr;
    demand(gp_abilities_list_new(&models));
    CameraAbilities abilities{};
    int result = gp_abilities_list_load(models, context_.get());
    if (result >= GP_OK) result = gp_abilities_list_lookup_model(models, model.c_str());
    if (result >= GP_OK) result = gp_abilities_list_get_abilities(models, result, &abilities);
    if (result >= GP_OK) result = gp_camera_set_abilities(camera_.get(), abilities);
    gp_abilities_list_free(models);
    demand(result);
  }
  [[nodiscard]] Held<CameraWidget> configuration() {
    CameraWidget* root = nullptr;
    demand(gp_camera_get_config(camera_.get(), &root, context_.get()));
    return Held<CameraWidget>(root);
  }
  /// Only those that hold text: menus and fields.
  static CameraWidget* widgetOf(CameraWidget* root, const std::string& name) {
    CameraWidget* widget = nullptr;
    CameraWidgetType type{};
    if (gp_widget_get_child_by_name(root, name.c_str(), &widget) < GP_OK) return nullptr;
    if (gp_widget_get_type(widget, &type) < GP_OK) return nullptr;
    const bool holdsText = type == GP_WIDGET_RADIO || type == GP_WIDGET_MENU || type == GP_WIDGET_TEXT;
    return holdsText ? widget : nullptr;
  }

  Held<GPContext> context_;
  Held<Camera> camera_;
};

}  // namespace

std::vector<std::pair<std::string, std::string>> listStillDevices() {
  const Held<GPContext> context(gp_context_new());
  const auto list = found(context.get());
  std::vector<std::pair<std::string, std::string>> all;
  for (int i = 0; i < gp_list_count(list.get()); ++i) {
    const char* model = nullptr;
    const char* port = nullptr;
    if (gp_list_get_name(list.get(), i, &model) < GP_OK || gp_list_get_value(list.get(), i, &port) < GP_OK) continue;
    all.emplace_back(model, port);
  }
  return all;
}

std::unique_ptr<StillDevice> openStillDevice(const std::string& name) {
  for (const auto& [model, port] : listStillDevices()) {
    if (name == "first" || name == model || name == port) return std::make_unique<GphotoDevice>(model, port);
  }
  throw std::runtime_error(
      "there is no such camera on USB: is it on, and awake? pixelflex camera list shows those there "
      "are");
}

}  // namespace pixelflex::devices
