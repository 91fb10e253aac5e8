"""Contacts of the robot with people, judged: does the robot cause them?"""
