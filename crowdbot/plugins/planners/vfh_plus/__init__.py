"""Vector field histogram with the robot's width and turning."""
