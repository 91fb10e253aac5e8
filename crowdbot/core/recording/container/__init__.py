"""The MCAP file: chunks, records and attached files, written and read within limits."""
