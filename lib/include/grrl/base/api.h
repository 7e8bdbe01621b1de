/*
 * api.h: wraps the declarations of each public header. They get C linkage in C++, and stay visible
 * in a shared library that hides everything else.
 */
#ifndef GRRL_BASE_API_H
#define GRRL_BASE_API_H

#if defined(__GNUC__)
#define GRRL_VISIBLE_BEGIN _Pragma("GCC visibility push(default)")
#define GRRL_VISIBLE_END _Pragma("GCC visibility pop")
#else
#define GRRL_VISIBLE_BEGIN
#define GRRL_VISIBLE_END
#endif

#ifdef __cplusplus
#define GRRL_API_BEGIN                                                                             \
    GRRL_VISIBLE_BEGIN extern "C"                                                                  \
    {
#define GRRL_API_END                                                                               \
    }                                                                                              \
    GRRL_VISIBLE_END
#else
#define GRRL_API_BEGIN GRRL_VISIBLE_BEGIN
#define GRRL_API_END GRRL_VISIBLE_END
#endif

#endif
