/*
 * lcm_eye.hpp: the eye on LCM: images in, points out. docs/messages.md describes the protocol.
 *
 * Points carry the session, frame, trial, push and phase of their image. A repeated image, as in
 * lock-step, is answered again with the same points. Points of an own camera have their own
 * session: see publish_own.
 */
#ifndef GRRL_TRACK_LCM_EYE_HPP
#define GRRL_TRACK_LCM_EYE_HPP

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lcm/lcm.h>

#include "eye.hpp"
#include "subscriptions.hpp"
#include "table.hpp"
#include "wire.h"

namespace grrl_track
{

class LcmEye
{
public:
    /* Throws std::runtime_error if LCM refuses a subscription. */
    LcmEye(lcm_t *lcm, std::function<int64_t()> now_us,
           std::function<void(const std::string &)> tell);
    LcmEye(const LcmEye &) = delete;
    LcmEye &operator=(const LcmEye &) = delete;

    /* The newest unprocessed image, if there is one; new_scene: it shows a different trial than the
     * last. publish_points answers it. */
    bool next(cv::Mat &picture, Motion &motion, bool &new_scene);
    void publish_points(const std::vector<Point> &points, const Table &table);

    /* Publishes points of an own camera. */
    void publish_own(int64_t session_id, const std::vector<Point> &points, const Table &table);

    /* The robot's tool position in metres, during the push of the image. */
    std::optional<cv::Point2d> tool() const;

    /* The supervisor of the images has no further trials. */
    bool finished() const { return finished_; }
    bool pictures_came() const { return session_id_ != 0; }

private:
    template <void (LcmEye::*handler)(const lcm_recv_buf_t &)>
    static void receive(const lcm_recv_buf_t *buffer, const char *channel, void *user);
    void on_image(const lcm_recv_buf_t &buffer);
    void on_push_status(const lcm_recv_buf_t &buffer);
    void on_trial(const lcm_recv_buf_t &buffer);
    bool known(int64_t session_id);
    void fill(const std::vector<Point> &points, const Table &table);
    void publish();
    void tell_once(bool &told, const std::string &text);

    lcm_t *lcm_;
    std::function<int64_t()> now_us_;
    std::function<void(const std::string &)> tell_;
    grrl_lcm::Subscriptions subscriptions_;
    std::unique_ptr<grrl_wire_image> incoming_;
    std::unique_ptr<grrl_wire_image> image_; /* to be processed, or the last one processed */
    bool pending_ = false;
    int64_t session_id_ = 0;
    int64_t heard_us_ = 0;
    int32_t trial_id_ = -1;
    grrl_push_status_t status_{};
    grrl_wire_points points_{}; /* the last ones sent */
    int64_t own_seq_ = 0;
    bool finished_ = false;
    bool told_rejected_ = false;
    bool told_foreign_ = false;
    uint8_t bytes_[GRRL_WIRE_MAX_BYTES];
};

} // namespace grrl_track

#endif
