"""Shows what happens on the bus, live or from a log: the command grrl-view; docs/view.md."""

from .run import Frame, Joint, Link, ModelSeen, Push, Run, Trial, read_log

__all__ = ["Frame", "Joint", "Link", "ModelSeen", "Push", "Run", "Trial", "read_log"]
