// SPDX-License-Identifier: Apache-2.0
#include "perception/vision/vision_detector.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <mutex>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>
#include <utility>

#include "perception/vision/box_outputs.hpp"
#include "perception/vision/onnx_input.hpp"

namespace adit::perception {
namespace {

constexpr std::size_t kMaxModel = std::size_t{512} << 20;  // Bytes of an ONNX file.
constexpr std::size_t kMaxLabels = 4096, kMaxLabel = 64;   // Lines of a file of labels, and bytes of one.
constexpr int kGrey = 114;                                 // Beside the picture, as YOLO was trained.

/// OpenCV reports by exceptions, and writes their text to the standard error, too.
int quiet(int /*status*/, const char* /*function*/, const char* /*text*/, const char* /*file*/, int /*line*/,
          void* /*user*/) {
  return 0;
}

/// Pictures come one at a time, on a thread of the agent's own pool.
void set_up_opencv() {
  static std::once_flag once;
  std::call_once(once, [] {
    cv::setNumThreads(1);
    cv::redirectError(quiet);
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  });
}

/// OpenCV throws cv::Exception, and the standard library's exceptions where a model makes it allocate or
/// index.
Error failed(const std::exception& why, Reason reason) {
  const auto* own = dynamic_cast<const cv::Exception*>(&why);
  return {reason, "OpenCV: " + (own == nullptr || own->err.empty() ? std::string(why.what()) : own->err)};
}

/// The pixels, not copied; the matrix is only read.
cv::Mat view_of(const Picture& picture) {
  return {static_cast<int>(picture.height), static_cast<int>(picture.width),
          picture.channels == 3 ? CV_8UC3 : CV_8UC1,
          const_cast<std::uint8_t*>(picture.bytes.data())};  // NOLINT: OpenCV has no view of constant pixels.
}

bool is_sound(const Picture& picture) {
  return picture.width > 0 && picture.height > 0 && (picture.channels == 1 || picture.channels == 3) &&
         picture.bytes.size() == std::size_t{picture.width} * picture.height * picture.channels;
}

Result<std::vector<std::uint8_t>> read_model(const std::string& path) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const auto size = in ? static_cast<std::streamoff>(in.tellg()) : 0;
  if (!in || size <= 0)
    return Error{Reason::cannot_read, "the model " + path + " cannot be read, or is empty"};
  if (static_cast<std::size_t>(size) > kMaxModel)
    return Error{Reason::out_of_range, "the model " + path + " has more than 512 MB"};
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!in) return Error{Reason::cannot_read, "the model " + path + " cannot be read"};
  return bytes;
}

/// The classes of a network.
struct Labels {
  std::vector<std::string> names{};
  bool background{};  ///< Class 0 of the network is none of them: the file begins with BACKGROUND.
};

Result<Labels> read_labels(const std::string& path) {
  std::ifstream in(path);
  if (!in) return Error{Reason::cannot_read, "the labels " + path + " cannot be read"};
  Labels labels;
  std::vector<std::string>& out = labels.names;
  for (std::string line; std::getline(in, line);) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    if (line.size() > kMaxLabel || out.size() >= kMaxLabels)
      return Error{Reason::malformed,
                   "the labels " + path + ": expected one class a line, at most 4096 of 64 characters"};
    out.push_back(line);
  }
  while (!out.empty() && out.back().empty()) out.pop_back();
  labels.background = !out.empty() && (out.front() == "BACKGROUND" || out.front() == "background");
  if (labels.background) out.erase(out.begin());
  if (out.empty() || std::ranges::find(out, "") != out.end())
    return Error{Reason::malformed,
                 "the labels " + path + ": expected one class a line, without empty lines"};
  return labels;
}

/// A network in an ONNX file.
class NetworkDetector final : public ObjectDetector {
 public:
  NetworkDetector(DetectorParams params, cv::dnn::Net net, OnnxInput input, Labels labels)
      : params_(std::move(params)), net_(std::move(net)), input_(input), labels_(std::move(labels)) {
    net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  }

  std::uint32_t picture_side() const override { return std::max(input_.width, input_.height); }

  Result<std::vector<ObjectBox>> detect(const Picture& picture) override {
    if (!is_sound(picture)) return Error{Reason::internal, "a picture without pixels"};
    try {
      return detect_in(view_of(picture));
    } catch (const std::exception& why) {
      return failed(why, Reason::internal);
    }
  }

 private:
  Result<std::vector<ObjectBox>> detect_in(const cv::Mat& picture) {
    // Scaled with the ratio of its sides, in the middle of the network's picture.
    const double width = input_.width, height = input_.height;
    const double scale = std::min(width / picture.cols, height / picture.rows);
    const cv::Size inner(std::max(1, static_cast<int>(std::lround(picture.cols * scale))),
                         std::max(1, static_cast<int>(std::lround(picture.rows * scale))));
    const int left = (static_cast<int>(input_.width) - inner.width) / 2;
    const int top = (static_cast<int>(input_.height) - inner.height) / 2;
    cv::Mat colour, scaled;
    if (picture.channels() == 1)
      cv::cvtColor(picture, colour, cv::COLOR_GRAY2RGB);
    else
      colour = picture;
    cv::resize(colour, scaled, inner, 0, 0, cv::INTER_AREA);
    cv::Mat whole(static_cast<int>(input_.height), static_cast<int>(input_.width), CV_8UC3,
                  cv::Scalar(kGrey, kGrey, kGrey));
    scaled.copyTo(whole(cv::Rect(left, top, inner.width, inner.height)));
    net_.setInput(cv::dnn::blobFromImage(whole, params_.scale, {},
                                         cv::Scalar(params_.mean, params_.mean, params_.mean)));
    std::vector<cv::Mat> results;
    net_.forward(results, net_.getUnconnectedOutLayersNames());
    std::vector<OutputTensor> outputs;
    for (cv::Mat& each : results) {
      if (each.type() != CV_32F || !each.isContinuous())
        return Error{Reason::malformed, "it returns no tensors of floats"};
      outputs.push_back({{each.size.p, each.size.p + each.dims}, {each.ptr<float>(), each.total()}});
    }
    auto raw =
        read_boxes(outputs, labels_.names.size(), labels_.background, width, height, params_.min_score);
    if (!raw) return raw.error();
    std::vector<ObjectBox> out;
    for (const RawBox& box : without_overlaps(std::move(*raw), kMaxBoxes)) {
      const auto across = [&](double x) { return std::clamp((x - left) / inner.width, 0.0, 1.0); };
      const auto down = [&](double y) { return std::clamp((y - top) / inner.height, 0.0, 1.0); };
      out.push_back({.kind = labels_.names[box.label],
                     .score = box.score,
                     .left = across(box.left),
                     .top = down(box.top),
                     .width = across(box.right) - across(box.left),
                     .height = down(box.bottom) - down(box.top)});
    }
    std::erase_if(out, [](const ObjectBox& box) { return box.width <= 0.0 || box.height <= 0.0; });
    return out;
  }

  DetectorParams params_;
  cv::dnn::Net net_;
  OnnxInput input_;
  Labels labels_;
};

/// Upright people, by histograms of oriented gradients.
class PeopleDetector final : public ObjectDetector {
 public:
  explicit PeopleDetector(double min_score) : min_score_(min_score) {
    hog_.setSVMDetector(cv::HOGDescriptor::getDefaultPeopleDetector());
  }

  std::uint32_t picture_side() const override { return 640; }

  Result<std::vector<ObjectBox>> detect(const Picture& picture) override {
    if (!is_sound(picture)) return Error{Reason::internal, "a picture without pixels"};
    std::vector<cv::Rect> found;
    std::vector<double> weights;
    try {
      cv::Mat grey = view_of(picture);
      if (picture.channels == 3) {
        cv::Mat out;
        cv::cvtColor(grey, out, cv::COLOR_RGB2GRAY);
        grey = out;
      }
      if (grey.cols < hog_.winSize.width || grey.rows < hog_.winSize.height) return std::vector<ObjectBox>{};
      hog_.detectMultiScale(grey, found, weights, 0.0, cv::Size(8, 8), cv::Size(8, 8), 1.05, 2.0);
    } catch (const std::exception& why) {
      return failed(why, Reason::internal);
    }
    std::vector<ObjectBox> out;
    for (std::size_t i = 0; i < found.size() && i < weights.size(); ++i) {
      // The margin of the classifier as a score: 0.5 at 0.7, where half of the windows on people are.
      const double score = 1.0 - std::exp(-std::max(0.0, weights[i]));
      if (score < min_score_) continue;
      // Its windows are larger than people: 96 of 128 pixels high, 32 of 64 wide.
      const double width = picture.width, height = picture.height;
      ObjectBox box{.kind = "person", .score = score, .shortest = 1.0, .tallest = 2.4};
      box.left = std::clamp((found[i].x + 0.2 * found[i].width) / width, 0.0, 1.0);
      box.top = std::clamp((found[i].y + 0.1 * found[i].height) / height, 0.0, 1.0);
      box.width = std::min(0.6 * found[i].width / width, 1.0 - box.left);
      box.height = std::min(0.8 * found[i].height / height, 1.0 - box.top);
      out.push_back(box);
    }
    std::ranges::stable_sort(out, [](const ObjectBox& a, const ObjectBox& b) { return a.score > b.score; });
    if (out.size() > kMaxBoxes) out.resize(kMaxBoxes);
    return out;
  }

 private:
  cv::HOGDescriptor hog_{};
  double min_score_;
};

}  // namespace

Result<std::shared_ptr<ObjectDetector>> make_vision_detector(const DetectorParams& params) {
  set_up_opencv();
  if (params.model.empty())
    return std::shared_ptr<ObjectDetector>(std::make_shared<PeopleDetector>(params.min_score));
  if (params.labels.empty())
    return Error{Reason::missing_key, "the model " + params.model + " needs a file of labels"};
  auto labels = read_labels(params.labels);
  if (!labels) return labels.error();
  const auto bytes = read_model(params.model);
  if (!bytes) return bytes.error();
  const auto about = [&params](const Error& why) {
    return Error{why.reason, "the model " + params.model + ": " + why.text};
  };
  const auto input = read_onnx_input(*bytes);
  if (!input) return about(input.error());
  try {
    auto net = cv::dnn::readNetFromONNX(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    auto detector = std::make_shared<NetworkDetector>(params, std::move(net), *input, std::move(*labels));
    // A network that does something else fails here, not at the first picture in the field.
    Picture grey{.width = input->width, .height = input->height, .channels = 3};
    grey.bytes.assign(std::size_t{3} * grey.width * grey.height, kGrey);
    if (const auto tried = detector->detect(grey); !tried) return about(tried.error());
    return std::shared_ptr<ObjectDetector>(std::move(detector));
  } catch (const std::exception& why) {
    return about(failed(why, Reason::malformed));
  }
}

}  // namespace adit::perception
