/* object_stream.cpp: reads a distribution of objects, and draws from it. */
#include "object_stream.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace grrl_sim
{

namespace
{

constexpr int attempts_with_loops = 200; /* loops that do not close are drawn anew */
constexpr int smallest_loop = 4;
constexpr int greatest_loop = 5;
constexpr uint16_t object_nodes = 256;

struct Row {
    const char *name;
    bool whole;
    double least;
    double most;
    double usual_low;
    double usual_high;
};

/* In the order of ObjectStream::Setting. */
const Row rows[ObjectStream::SETTINGS] = {
    {"links", true, 2, 10, 3, 6},        {"objects", true, 1, 4, 1, 1},
    {"revolute", false, 0, 1, 0.5, 0.5}, {"branches", false, 0, 1, 0, 0},
    {"loops", false, 0, 1, 0, 0},        {"size", false, 0.4, 2, 1, 1},
    {"length", false, 0.5, 2, 1, 1},     {"width", false, 0.5, 2, 1, 1},
    {"friction", false, 0, 5, 1, 1},
};

class StreamParser
{
public:
    StreamParser(const std::string &text, std::string path) : text_(text), path_(std::move(path)) {}

    Result<ObjectStream> parse()
    {
        std::istringstream lines(text_);
        while (error_.empty() && std::getline(lines, line_)) {
            number_++;
            line_ = line_.substr(0, line_.find('#'));
            statement();
        }
        if (error_.empty())
            check_capacity();
        return error_.empty() ? Result<ObjectStream>::good(stream_)
                              : Result<ObjectStream>::bad(error_);
    }

private:
    void fail(size_t at, const std::string &message)
    {
        if (error_.empty())
            error_ = path_ + ":" + std::to_string(number_) + ":" + std::to_string(at + 1) + ": " +
                     message;
    }

    void statement()
    {
        size_t at = line_.find_first_not_of(" \t\r");
        if (at == std::string::npos)
            return;
        size_t end = std::min(line_.find_first_of(" \t\r", at), line_.size());
        std::string name = line_.substr(at, end - at);
        std::string known;
        for (int i = 0; i < ObjectStream::SETTINGS; i++) {
            known += (i == 0 ? "" : ", ") + std::string(rows[i].name);
            if (name == rows[i].name)
                return values(static_cast<ObjectStream::Setting>(i), at, end);
        }
        fail(at, "unknown statement '" + name + "'; expected one of " + known);
    }

    void values(ObjectStream::Setting setting, size_t name_at, size_t at)
    {
        if (given_[setting])
            return fail(name_at, std::string("a second '") + rows[setting].name +
                                     "'; separate several values by commas");
        given_[setting] = true;
        ObjectStream::Ranges ranges;
        for (bool more = true; more && error_.empty();) {
            size_t end = std::min(line_.find(',', at), line_.size());
            ranges.push_back(range(rows[setting], at, end));
            more = end < line_.size();
            at = end + 1;
        }
        stream_.set(setting, ranges);
    }

    ObjectStream::Range range(const Row &row, size_t at, size_t end)
    {
        size_t dots = line_.find("..", at);
        if (dots >= end)
            dots = end;
        ObjectStream::Range made{};
        made.low = number(row, at, dots);
        made.high = dots < end ? number(row, dots + 2, end) : made.low;
        if (error_.empty() && made.low > made.high)
            fail(at, "a range starts with its lower end");
        return made;
    }

    double number(const Row &row, size_t at, size_t end)
    {
        at = std::min(line_.find_first_not_of(" \t\r", at), end);
        std::string word = line_.substr(at, end - at);
        word.erase(word.find_last_not_of(" \t\r") + 1);
        char *rest = nullptr;
        double value = std::strtod(word.c_str(), &rest);
        bool good = !word.empty() && *rest == '\0' && value >= row.least && value <= row.most;
        if (good && (!row.whole || value == static_cast<int>(value)))
            return value;
        std::ostringstream message;
        message << "'" << word << "' must be a " << (row.whole ? "whole number" : "number")
                << " from " << row.least << " to " << row.most << ", or a range such as "
                << row.least << ".." << row.most;
        fail(at, message.str());
        return row.least;
    }

    void check_capacity()
    {
        auto most = [this](ObjectStream::Setting setting) {
            double greatest = 0.0;
            for (const ObjectStream::Range &range : stream_.ranges(setting))
                greatest = std::max(greatest, range.high);
            return static_cast<int>(greatest);
        };
        int links = most(ObjectStream::LINKS) * most(ObjectStream::OBJECTS);
        if (links > GRRL_MAX_LINKS)
            error_ = path_ + ": up to " + std::to_string(links) +
                     " links on the table; this build holds at most " +
                     std::to_string(GRRL_MAX_LINKS) + " (GRRL_MAX_LINKS)";
    }

    const std::string &text_;
    std::string path_;
    std::string line_;
    size_t number_ = 0;
    std::string error_;
    ObjectStream stream_;
    std::array<bool, ObjectStream::SETTINGS> given_{};
};

/* The capacity was checked when the stream was read. */
void join(ObjectSpec &object, grrl_joint_type type, int a, int b)
{
    if (grrl_graph_add_joint(&object.truth, static_cast<uint8_t>(a), static_cast<uint8_t>(b),
                             type) == GRRL_OK)
        object.joints.push_back(default_joint(type, a, b));
}

} // namespace

ObjectStream::ObjectStream()
{
    for (size_t i = 0; i < SETTINGS; i++)
        ranges_[i] = {{rows[i].usual_low, rows[i].usual_high}};
}

double ObjectStream::draw(Setting setting, Random &random) const
{
    const Ranges &ranges = ranges_[setting];
    const Range &range = ranges[static_cast<size_t>(random.below(static_cast<int>(ranges.size())))];
    return random.uniform(range.low, range.high);
}

int ObjectStream::draw_whole(Setting setting, Random &random) const
{
    const Ranges &ranges = ranges_[setting];
    const Range &range = ranges[static_cast<size_t>(random.below(static_cast<int>(ranges.size())))];
    int low = static_cast<int>(range.low);
    return low + random.below(static_cast<int>(range.high) - low + 1);
}

/* Adds links, joints and dimensions; the layout comes later. */
void ObjectStream::add_object(ObjectSpec &object, bool loops, Random &random) const
{
    int first = static_cast<int>(object.links.size());
    int links = draw_whole(LINKS, random);
    double revolute = draw(REVOLUTE, random);
    double branches = draw(BRANCHES, random);
    double size = draw(SIZE, random);
    bool has_loop = random.uniform() < draw(LOOPS, random) && links >= smallest_loop && loops;
    int ring =
        has_loop ? std::min(links, smallest_loop + random.below(greatest_loop - smallest_loop + 1))
                 : 0;
    auto type = [&] { return random.uniform() < revolute ? GRRL_REVOLUTE : GRRL_PRISMATIC; };
    size_t first_joint = object.joints.size();
    for (int i = 0; i < links; i++) {
        uint8_t index = 0;
        LinkSpec link = default_link(0);
        resize_link(link, size * draw(LENGTH, random), size * draw(WIDTH, random));
        link.name = "l" + std::to_string(first + i + 1);
        object.links.push_back(link);
        (void)!grrl_graph_add_link(&object.truth, 0, &index);
        if (i == 0)
            continue;
        bool branch = i >= ring && random.uniform() < branches;
        join(object, type(), branch ? first + random.below(i) : first + i - 1, first + i);
        if (i == ring - 1)
            join(object, type(), first + i, first);
    }
    for (size_t j = first_joint; j < object.joints.size(); j++)
        object.joints[j].friction *= draw(FRICTION, random);
}

ObjectSpec ObjectStream::sample(uint64_t seed, const ObjectScale &scale) const
{
    Random random(seed, Stream::SAMPLE);
    ObjectScale similar = scale;
    similar.similar = true;
    for (int attempt = 0;; attempt++) {
        ObjectSpec object;
        grrl_graph_clear(&object.truth);
        int objects = draw_whole(OBJECTS, random);
        for (int i = 0; i < objects; i++)
            add_object(object, attempt < attempts_with_loops, random);
        if (finish_object(object, similar).empty()) /* without loops always */
            return object;
    }
}

Result<ObjectStream> stream_from_text(const std::string &text, const std::string &path)
{
    return StreamParser(text, path).parse();
}

Result<ObjectStream> stream_from_file(const std::string &path)
{
    std::ifstream file(path);
    if (!file)
        return Result<ObjectStream>::bad(path + ": cannot be read; expected a file that describes "
                                                "a stream of objects");
    std::ostringstream text;
    text << file.rdbuf();
    return stream_from_text(text.str(), path);
}

std::string term_of(const ObjectSpec &object)
{
    std::vector<struct grrl_term_node> nodes(object_nodes);
    grrl_term_store store;
    grrl_term_store_init(&store, nodes.data(), object_nodes);
    grrl_name names[GRRL_MAX_LINKS];
    for (uint8_t i = 0; i < object.truth.n; i++) {
        bool background = object.truth.label[i] == GRRL_LABEL_BACKGROUND;
        names[i].kind = background ? GRRL_NAME_BACKGROUND : GRRL_NAME_LINK;
        names[i].number = background ? 0 : static_cast<uint16_t>(i + 1);
    }
    grrl_term term = 0;
    char text[1024];
    if (grrl_graph_to_term(&store, &object.truth, names, nullptr, 0, false, &term) != GRRL_OK ||
        grrl_term_print(&store, term, sizeof text, text, nullptr) != GRRL_OK)
        return {};
    return text;
}

} // namespace grrl_sim
