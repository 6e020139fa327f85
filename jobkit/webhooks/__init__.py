"""Webhooks: subscriptions, the outbox that changes of jobs fill, deliveries."""
