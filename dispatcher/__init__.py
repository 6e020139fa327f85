"""The dispatcher: one leading process does what is due for jobs, webhooks, retention and the scrub."""
