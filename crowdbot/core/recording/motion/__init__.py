"""The motion of people, packed: samples as messages, and the codec that predicts them."""
