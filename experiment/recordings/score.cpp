/* score.cpp: matches bodies by majority, and joints by their bodies. */
#include "score.hpp"

#include <algorithm>

namespace grrl_experiment::recordings
{

namespace
{

constexpr double max_error = 0.1;      /* of the tracks in a wrong body, for a right answer */
constexpr double least_assigned = 0.5; /* of the tracks of a moving body */

/* Number of tracks of each true body in each body of the answer; the last column counts those in
 * none. */
class Table
{
public:
    Table(const Recording &recording, const Estimate &estimate)
        : bodies_(static_cast<size_t>(recording.bodies)),
          links_(static_cast<size_t>(estimate.links)),
          count_(bodies_, std::vector<int>(links_ + 1, 0))
    {
        std::vector<bool> judged(recording.tracks.size());
        for (size_t id = 0; id < recording.tracks.size(); id++)
            judged[id] = recording.tracks[id].judged;
        for (auto [id, link] : estimate.features) {
            auto at = static_cast<size_t>(id);
            if (at >= judged.size() || !judged[at])
                continue;
            bool in_body = link >= 0 && link < estimate.links;
            size_t column = in_body ? static_cast<size_t>(link) : links_;
            count_[static_cast<size_t>(recording.tracks[at].body)][column]++;
        }
    }

    int true_body(size_t link) const
    {
        int best = no_link, most = 0;
        for (size_t b = 0; b < bodies_; b++) {
            if (count_[b][link] > most) {
                most = count_[b][link];
                best = static_cast<int>(b);
            }
        }
        return best;
    }

    /* The body of the answer with most tracks of a true one; no_link: none has any. */
    size_t link_of(size_t body) const
    {
        auto end = count_[body].end() - 1;
        return static_cast<size_t>(std::max_element(count_[body].begin(), end) -
                                   count_[body].begin());
    }

    double error() const
    {
        int in_body = 0, wrong = 0;
        for (size_t link = 0; link < links_; link++) {
            int of = true_body(link);
            for (size_t b = 0; b < bodies_; b++) {
                in_body += count_[b][link];
                wrong += static_cast<int>(b) != of ? count_[b][link] : 0;
            }
        }
        return in_body > 0 ? static_cast<double>(wrong) / in_body : 0.0;
    }

    /* Whether each moving body is one body of the answer with most of its tracks. The ground may be
     * one body; in metres several, since anything on a table may be an object. */
    bool right(bool in_metres) const
    {
        std::vector<int> times(bodies_, 0);
        for (size_t link = 0; link < links_; link++) {
            int of = true_body(link);
            if (of >= 0)
                times[static_cast<size_t>(of)]++;
        }
        for (size_t b = 0; b < bodies_; b++) {
            int assigned = 0;
            for (size_t link = 0; link < links_; link++)
                assigned += count_[b][link];
            bool most = assigned >= least_assigned * (assigned + count_[b][links_]);
            if ((times[b] > 1 && !(b == 0 && in_metres)) || (b > 0 && (times[b] == 0 || !most)))
                return false;
        }
        return error() <= max_error;
    }

private:
    size_t bodies_;
    size_t links_;
    std::vector<std::vector<int>> count_;
};

} // namespace

Score score(const Recording &recording, const Estimate &estimate)
{
    Table table(recording, estimate);
    Score score;
    score.bodies = estimate.links;
    score.bodies_right = table.right(recording.unit != Unit::PX);
    score.error = table.error();
    score.joints =
        static_cast<int>(std::count(recording.open.begin(), recording.open.end(), false));
    std::vector<EstimatedJoint> joints = estimate.joints;
    std::stable_sort(joints.begin(), joints.end(),
                     [](const auto &a, const auto &b) { return a.probability > b.probability; });
    std::vector<bool> known = recording.open; /* nobody misses those */
    for (const EstimatedJoint &joint : joints) {
        int a = table.true_body(static_cast<size_t>(joint.a));
        int b = table.true_body(static_cast<size_t>(joint.b));
        bool right = false;
        bool open = false;
        for (size_t i = 0; i < known.size() && !right; i++) {
            const Joint &truth = recording.joints[i];
            bool is_it = truth.a == std::min(a, b) && truth.b == std::max(a, b) &&
                         static_cast<int>(truth.type) == joint.type;
            open = open || (is_it && recording.open[i]);
            right = is_it && !known[i];
            known[i] = known[i] || (right && joint.probability >= called_probability);
        }
        if (open)
            continue; /* a guess, and it happens to be so */
        score.called.push_back({joint.probability, right});
        score.false_called += !right && joint.probability >= called_probability;
        score.false_sure += !right && joint.probability >= sure_probability;
    }
    score.missed = static_cast<int>(std::count(known.begin(), known.end(), false));
    score.right = score.bodies_right && score.missed == 0 && score.false_called == 0;
    return score;
}

} // namespace grrl_experiment::recordings
