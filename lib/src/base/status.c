/* The text for each status. */
#include "grrl/base/status.h"

const char *grrl_status_text(enum grrl_status status)
{
    switch (status) {
    case GRRL_OK:
        return "success";
    case GRRL_ERR_ARGUMENT:
        return "a parameter is outside its range";
    case GRRL_ERR_FULL:
        return "a fixed capacity is reached";
    case GRRL_ERR_SYNTAX:
        return "not a term";
    case GRRL_ERR_STRUCTURE:
        return "not a kinematic structure";
    case GRRL_ERR_NUMBER:
        return "a number is not finite or out of range";
    case GRRL_ERR_UNDECIDED:
        return "undecided within the search budget";
    case GRRL_ERR_NONE:
        return "nothing found";
    case GRRL_ERR_IO:
        return "reading or writing failed";
    case GRRL_ERR_FORMAT:
        return "not a file of this kind";
    case GRRL_ERR_VERSION:
        return "a file from another version or build";
    case GRRL_ERR_CORRUPT:
        return "a damaged file";
    case GRRL_ERR_ORDER:
        return "a function was called out of order";
    case GRRL_ERR_POLICY:
        return "a file from another policy";
    }
    return "unknown status";
}
