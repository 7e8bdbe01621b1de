"""A second world for grrl-agent: an articulated object on a table in MuJoCo, on LCM."""
