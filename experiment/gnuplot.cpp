/* gnuplot.cpp: runs gnuplot in a separate process. */
#include "gnuplot.hpp"

#include <cstdio>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace grrl_experiment
{

std::string gnuplot_quoted(const std::string &text)
{
    std::string result = "'";
    for (char c : text)
        result += c == '\'' ? std::string("''") : std::string(1, c == '\n' ? ' ' : c);
    return result + "'";
}

/* Passes the script in a file: writing to a pipe without a reader would end this process by a
 * signal. */
bool run_gnuplot(const std::string &folder, const std::string &script)
{
    std::FILE *input = std::tmpfile();
    if (input == nullptr)
        return false;
    (void)std::fputs(script.c_str(), input);
    std::rewind(input);
    (void)std::fflush(nullptr);
    pid_t pid = fork();
    if (pid == 0) {
        int none = open("/dev/null", O_WRONLY);
        if (none >= 0 && dup2(fileno(input), STDIN_FILENO) >= 0 && chdir(folder.c_str()) == 0) {
            (void)dup2(none, STDERR_FILENO);
            (void)execlp("gnuplot", "gnuplot", static_cast<char *>(nullptr));
        }
        _exit(127);
    }
    int status = 1;
    bool good =
        pid > 0 && waitpid(pid, &status, 0) == pid && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    (void)std::fclose(input);
    return good;
}

} // namespace grrl_experiment
