/* Receives images, tool positions and trials as messages, and sends points. */
#include "lcm_eye.hpp"

#include <opencv2/imgcodecs.hpp>

namespace grrl_track
{

namespace
{

constexpr int64_t silence_us = 1000000;

/* Empty if the bytes are not an image of this size. */
cv::Mat picture_of(const grrl_image_t &image)
{
    if (image.encoding == GRRL_IMAGE_T_RAW_GREY || image.encoding == GRRL_IMAGE_T_RAW_BGR) {
        int type = image.encoding == GRRL_IMAGE_T_RAW_GREY ? CV_8UC1 : CV_8UC3;
        return cv::Mat(image.height, image.width, type, image.data).clone();
    }
    cv::Mat bytes(1, image.n_bytes, CV_8UC1, image.data);
    cv::Mat picture;
    try {
        picture = cv::imdecode(bytes, cv::IMREAD_COLOR);
    } catch (const cv::Exception &) {
        return {};
    }
    return picture.cols == image.width && picture.rows == image.height ? picture : cv::Mat();
}

Motion motion_of(int8_t phase)
{
    switch (phase) {
    case GRRL_POINTS_T_UNKNOWN:
        return Motion::UNKNOWN;
    case GRRL_POINTS_T_PUSHING:
        return Motion::PUSHING;
    default:
        return Motion::REST;
    }
}

} // namespace

LcmEye::LcmEye(lcm_t *lcm, std::function<int64_t()> now_us,
               std::function<void(const std::string &)> tell)
    : lcm_(lcm), now_us_(std::move(now_us)), tell_(std::move(tell)), subscriptions_(lcm),
      incoming_(std::make_unique<grrl_wire_image>()), image_(std::make_unique<grrl_wire_image>())
{
    grrl_wire_bind_points(&points_);
    (void)subscriptions_.add(GRRL_CHANNEL_IMAGE, receive<&LcmEye::on_image>, this);
    (void)subscriptions_.add(GRRL_CHANNEL_PUSH_STATUS, receive<&LcmEye::on_push_status>, this);
    (void)subscriptions_.add(GRRL_CHANNEL_TRIAL, receive<&LcmEye::on_trial>, this);
}

template <void (LcmEye::*handler)(const lcm_recv_buf_t &)>
void LcmEye::receive(const lcm_recv_buf_t *buffer, const char *, void *user)
{
    (static_cast<LcmEye *>(user)->*handler)(*buffer);
}

void LcmEye::tell_once(bool &told, const std::string &text)
{
    if (!told)
        tell_(text);
    told = true;
}

/* Another sender takes over if the known one has been silent: it was restarted. */
bool LcmEye::known(int64_t session_id)
{
    int64_t now = now_us_();
    if (session_id_ != 0 && session_id != session_id_ && now - heard_us_ < silence_us) {
        tell_once(told_foreign_, "another camera or simulator is sending images, too; it is "
                                 "ignored while the first one is present");
        return false;
    }
    if (session_id != session_id_) {
        session_id_ = session_id;
        trial_id_ = -1;
        pending_ = false;
        image_->message.seq = 0;
        points_.message.seq = 0;
    }
    heard_us_ = now;
    return true;
}

void LcmEye::on_image(const lcm_recv_buf_t &buffer)
{
    grrl_wire_why why;
    if (!grrl_wire_decode_image(buffer.data, buffer.data_size, incoming_.get(), &why))
        return tell_once(told_rejected_, why.text);
    const grrl_image_t &image = incoming_->message;
    if (!known(image.session_id))
        return;
    if (image.seq == points_.message.seq && image.session_id == points_.message.session_id) {
        publish(); /* the answer was lost */
    } else if (image.seq > image_->message.seq) {
        std::swap(incoming_, image_);
        pending_ = true;
    }
}

void LcmEye::on_push_status(const lcm_recv_buf_t &buffer)
{
    grrl_push_status_t status;
    grrl_wire_why why;
    if (grrl_wire_decode_push_status(buffer.data, buffer.data_size, &status, &why))
        status_ = status;
    else
        tell_once(told_rejected_, why.text);
}

void LcmEye::on_trial(const lcm_recv_buf_t &buffer)
{
    grrl_trial_t trial;
    grrl_wire_why why;
    if (!grrl_wire_decode_trial(buffer.data, buffer.data_size, &trial, &why))
        return tell_once(told_rejected_, why.text);
    finished_ = finished_ || (trial.session_id == session_id_ && session_id_ != 0 &&
                              trial.phase == GRRL_TRIAL_T_FINISHED);
}

bool LcmEye::next(cv::Mat &picture, Motion &motion, bool &new_scene)
{
    if (!pending_)
        return false;
    pending_ = false;
    const grrl_image_t &image = image_->message;
    picture = picture_of(image);
    if (picture.empty()) {
        tell_once(told_rejected_, "image_t: the bytes are not an image of the given size");
        return false;
    }
    motion = motion_of(image.phase);
    new_scene = image.trial_id != trial_id_;
    trial_id_ = image.trial_id;
    return true;
}

std::optional<cv::Point2d> LcmEye::tool() const
{
    const grrl_image_t &image = image_->message;
    bool ours = session_id_ == 0 ||
                (status_.session_id == image.session_id && status_.trial_id == image.trial_id &&
                 status_.cmd_seq == image.ack_cmd_seq);
    bool lifted = status_.tool[0] == 0.0f && status_.tool[1] == 0.0f;
    if (!ours || lifted || status_.state != GRRL_PUSH_STATUS_T_MOVING)
        return std::nullopt;
    return cv::Point2d(static_cast<double>(status_.tool[0]), static_cast<double>(status_.tool[1]));
}

void LcmEye::fill(const std::vector<Point> &points, const Table &table)
{
    int32_t n = 0;
    for (const Point &point : points) {
        if (!point.visible || n == GRRL_WIRE_MAX_POINTS)
            continue;
        cv::Point2d m =
            table.to_m(cv::Point2d(static_cast<double>(point.x), static_cast<double>(point.y)));
        points_.id[n] = point.id;
        points_.x[n] = static_cast<float>(m.x);
        points_.y[n] = static_cast<float>(m.y);
        n++;
    }
    points_.message.n_points = n;
}

void LcmEye::publish_points(const std::vector<Point> &points, const Table &table)
{
    const grrl_image_t &image = image_->message;
    grrl_points_t &out = points_.message;
    out.session_id = image.session_id;
    out.seq = image.seq;
    out.trial_id = image.trial_id;
    out.ack_cmd_seq = image.ack_cmd_seq;
    out.agent_session_id = image.agent_session_id;
    out.mode = image.mode;
    out.phase = image.phase;
    fill(points, table);
    publish();
}

void LcmEye::publish_own(int64_t session_id, const std::vector<Point> &points, const Table &table)
{
    grrl_points_t &out = points_.message;
    out.session_id = session_id;
    out.seq = ++own_seq_;
    out.mode = GRRL_POINTS_T_REAL_TIME;
    out.phase = GRRL_POINTS_T_UNKNOWN;
    fill(points, table);
    publish();
}

void LcmEye::publish()
{
    grrl_wire_why why;
    points_.message.utime = now_us_();
    int size = grrl_wire_encode_points(&points_.message, GRRL_WIRE_MAX_BYTES, bytes_, &why);
    if (size < 0)
        tell_(why.text);
    else if (lcm_publish(lcm_, GRRL_CHANNEL_POINTS, bytes_, static_cast<unsigned>(size)) != 0)
        tell_("LCM could not send a message");
}

} // namespace grrl_track
