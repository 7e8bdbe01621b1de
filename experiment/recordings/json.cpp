/* json.cpp: parses JSON by recursive descent. */
#include "json.hpp"

#include <cstdlib>
#include <cstring>

namespace grrl_experiment::recordings
{

namespace
{

enum { DEEPEST = 32 };

class Reader
{
public:
    explicit Reader(const std::string &text) : at_(text.c_str()) {}

    bool value(Json &json, int depth)
    {
        skip();
        if (depth > DEEPEST)
            return false;
        if (*at_ == '{' || *at_ == '[')
            return list(json, *at_ == '{', depth);
        if (*at_ == '"')
            return quoted(json.text);
        return number(json);
    }

    bool at_end()
    {
        skip();
        return *at_ == '\0';
    }

private:
    void skip() { at_ += std::strspn(at_, " \t\r\n"); }

    bool take(char c)
    {
        skip();
        at_ += *at_ == c;
        return at_[-1] == c;
    }

    bool quoted(std::string &text)
    {
        const char *begin = ++at_;
        while (*at_ != '"' && *at_ != '\0')
            at_ += *at_ == '\\' && at_[1] != '\0' ? 2 : 1;
        text.assign(begin, at_);
        return *at_ == '"' && *at_++ == '"';
    }

    bool number(Json &json)
    {
        for (const char *word : {"true", "false", "null"}) {
            size_t n = std::strlen(word);
            if (std::strncmp(at_, word, n) == 0) {
                json.number = *word == 't';
                at_ += n;
                return true;
            }
        }
        char *end;
        json.number = std::strtod(at_, &end);
        bool any = end != at_;
        at_ = end;
        return any;
    }

    bool list(Json &json, bool named, int depth)
    {
        char close = named ? '}' : ']';
        at_++;
        skip();
        if (*at_ == close) {
            at_++;
            return true;
        }
        for (;;) {
            skip();
            if (named) {
                json.names.emplace_back();
                if (*at_ != '"' || !quoted(json.names.back()) || !take(':'))
                    return false;
            }
            json.items.emplace_back();
            if (!value(json.items.back(), depth + 1))
                return false;
            skip();
            if (*at_ != ',' && *at_ != close)
                return false;
            if (*at_++ == close)
                return true;
        }
    }

    const char *at_;
};

} // namespace

const Json &Json::operator[](const std::string &name) const
{
    static const Json nothing;
    for (size_t i = 0; i < names.size(); i++)
        if (names[i] == name)
            return items[i];
    return nothing;
}

std::optional<Json> read_json(const std::string &text)
{
    Reader reader(text);
    Json json;
    if (!reader.value(json, 0) || !reader.at_end())
        return std::nullopt;
    return json;
}

} // namespace grrl_experiment::recordings
