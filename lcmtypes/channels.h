/* channels.h: the names of all LCM channels. docs/messages.md says who sends on which. */
#ifndef GRRL_CHANNELS_H
#define GRRL_CHANNELS_H

#define GRRL_CHANNEL_POINTS "GRRL_POINTS"             /* points_t */
#define GRRL_CHANNEL_IMAGE "GRRL_IMAGE"               /* image_t */
#define GRRL_CHANNEL_PUSH_COMMAND "GRRL_PUSH_COMMAND" /* push_command_t */
#define GRRL_CHANNEL_PUSH_STATUS "GRRL_PUSH_STATUS"   /* push_status_t */
#define GRRL_CHANNEL_TRIAL "GRRL_TRIAL"               /* trial_t */
#define GRRL_CHANNEL_MODEL "GRRL_MODEL"               /* model_t */
#define GRRL_CHANNEL_DECISION "GRRL_DECISION"         /* decision_t */
#define GRRL_CHANNEL_AGENT_STATUS "GRRL_AGENT_STATUS" /* agent_status_t */
#define GRRL_CHANNEL_STOP "GRRL_STOP"                 /* stop_t */

#endif
